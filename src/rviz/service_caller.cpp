#include "src/rviz/service_caller.hpp"

#include <QMetaObject>

namespace desert_sim {

ServiceCaller::ServiceCaller(QObject* parent) : QObject(parent), thread_([this] { loop(); }) {}

ServiceCaller::~ServiceCaller() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    ending_ = true;
  }
  cancel();
  wake_up_.notify_all();
  thread_.join();
}

void ServiceCaller::work(std::function<std::function<void()>()> job) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    jobs_.push_back({std::move(job), generation_});
  }
  wake_up_.notify_all();
}

void ServiceCaller::cancel() {
  ros::ServiceClient current;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    ++generation_;
    jobs_.clear();
    current = current_;
  }
  if (current) current.shutdown();  // which makes its call() fail
}

bool ServiceCaller::begin(const ros::ServiceClient& client) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (job_generation_ != generation_) return false;
  current_ = client;
  return true;
}

void ServiceCaller::end() {
  const std::lock_guard<std::mutex> lock(mutex_);
  current_ = ros::ServiceClient();
}

void ServiceCaller::loop() {
  while (true) {
    Job job;
    {
      std::unique_lock<std::mutex> lock(mutex_);
      wake_up_.wait(lock, [this] { return ending_ || !jobs_.empty(); });
      if (ending_) return;
      job = std::move(jobs_.front());
      jobs_.pop_front();
      job_generation_ = job.generation;
    }
    const std::function<void()> done = job.work();
    QMetaObject::invokeMethod(
        this,
        [this, done, generation = job.generation] {
          {
            const std::lock_guard<std::mutex> lock(mutex_);
            if (generation != generation_) return;
          }
          done();
        },
        Qt::QueuedConnection);
  }
}

}  // namespace desert_sim
