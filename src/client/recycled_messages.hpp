#pragma once
/// Makes messages for roscpp to deserialise into, in the memory of one that nobody needs any more. Otherwise
/// each map of a terrain would be written to fresh pages, which the system fills with zeros, and std::vector
/// after it.

#include <boost/shared_ptr.hpp>
#include <memory>
#include <mutex>
#include <utility>

namespace desert_sim {

/// Keeps one unused message at most. Copies share it. From any thread.
template <class Message>
class RecycledMessages {
 public:
  boost::shared_ptr<Message> operator()() const {
    std::unique_ptr<Message> message = unused_->exchange(nullptr);
    if (!message) message = std::make_unique<Message>();
    return {message.release(),
            [unused = unused_](Message* used) { unused->exchange(std::unique_ptr<Message>(used)); }};
  }

 private:
  class Unused {
   public:
    std::unique_ptr<Message> exchange(std::unique_ptr<Message> message) {
      const std::lock_guard<std::mutex> lock(mutex_);
      message_.swap(message);
      return message;
    }

   private:
    std::mutex mutex_;
    std::unique_ptr<Message> message_;
  };

  std::shared_ptr<Unused> unused_ = std::make_shared<Unused>();
};

}  // namespace desert_sim
