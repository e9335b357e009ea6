#include "src/ros/support/job_queue.hpp"

#include <algorithm>

namespace desert_sim {

std::uint64_t JobQueue::push(Job job) {
  std::string reason;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    job.number = ++pushed_;
    if (!closed_) {
      jobs_.push_back(std::move(job));
      changed_.notify_all();
      return pushed_;
    }
    reason = reason_;
  }
  job.reject(std::make_exception_ptr(Error(reason)));
  return job.number;
}

bool JobQueue::withdraw(std::uint64_t number) {
  const std::lock_guard<std::mutex> lock(mutex_);
  const auto job =
      std::find_if(jobs_.begin(), jobs_.end(), [number](const Job& j) { return j.number == number; });
  if (job == jobs_.end()) return false;
  jobs_.erase(job);
  return true;
}

bool JobQueue::pop(Job& job) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (jobs_.empty()) return false;
  job = std::move(jobs_.front());
  jobs_.pop_front();
  return true;
}

void JobQueue::wait_for(std::chrono::duration<double> time, const MonotonicClock& clock) {
  const auto end = clock.now() + std::chrono::duration_cast<MonotonicClock::Duration>(time);
  std::unique_lock<std::mutex> lock(mutex_);
  if (!closed_ && jobs_.empty()) clock.wait_until(changed_, lock, end);
}

void JobQueue::close(const std::string& reason) {
  std::deque<Job> remaining;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (!closed_) reason_ = reason;
    closed_ = true;
    remaining.swap(jobs_);
    changed_.notify_all();
  }
  for (Job& job : remaining) job.reject(std::make_exception_ptr(Error(reason)));
}

bool JobQueue::closed() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return closed_;
}

}  // namespace desert_sim
