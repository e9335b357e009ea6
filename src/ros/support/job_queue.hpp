#pragma once
/// The queue of jobs that other threads want the simulation thread to do between two steps.

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <future>
#include <memory>
#include <mutex>
#include <string>

#include "src/core/error.hpp"
#include "src/core/monotonic_clock.hpp"

namespace desert_sim {

/// A job, and the promise to which it gives its answer.
struct Job {
  std::function<void()> run;  ///< may throw after it has answered with the same exception
  std::function<void(std::exception_ptr)> reject;
  std::uint64_t number = 0;  ///< given by the queue
};

/// Makes a job of `body`, which returns R. Refused input (ConfigError) and a file that cannot be written
/// (WriteError) are only thrown to the thread that asked; any other exception is thrown to both threads.
template <class R>
Job make_job(std::function<R()> body, std::future<R>& answer) {
  auto promise = std::make_shared<std::promise<R>>();
  answer = promise->get_future();
  Job job;
  job.run = [promise, body] {
    try {
      if constexpr (std::is_void_v<R>) {
        body();
        promise->set_value();
      } else {
        promise->set_value(body());
      }
    } catch (const ConfigError&) {
      promise->set_exception(std::current_exception());
    } catch (const WriteError&) {
      promise->set_exception(std::current_exception());
    } catch (...) {
      promise->set_exception(std::current_exception());
      throw;
    }
  };
  job.reject = [promise](std::exception_ptr exception) { promise->set_exception(exception); };
  return job;
}

/// Many threads put jobs, one takes them. The mutex is not held while a job runs.
class JobQueue {
 public:
  /// Returns the job's number. Once the queue is closed, the job is refused with the reason of close().
  std::uint64_t push(Job job);
  /// Takes the job of this number out of the queue; false if it has been popped, and may be running.
  bool withdraw(std::uint64_t number);
  /// The next job, if there is one.
  bool pop(Job& job);
  /// Sleeps until there is a job, the queue is closed, or the time [s] is over by the clock;
  /// perhaps not so long.
  void wait_for(std::chrono::duration<double> time, const MonotonicClock& clock);
  /// Refuses the jobs that wait and all that come. The first reason stays.
  void close(const std::string& reason);
  bool closed() const;

 private:
  mutable std::mutex mutex_;  ///< guards all below
  std::condition_variable changed_;
  std::deque<Job> jobs_;
  std::uint64_t pushed_ = 0;
  bool closed_ = false;
  std::string reason_;
};

}  // namespace desert_sim
