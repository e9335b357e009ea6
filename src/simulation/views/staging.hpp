#pragma once
/// The way of results to the host while the simulation goes on. Laws write them to staging memory on the
/// device, from where they are copied to the host beside the next steps; whoever needs them waits for that
/// copy and for nothing else.
///
/// There are two slots of staging memory, so that the next result can be written while the last one is on its
/// way. A result that is larger than a slot goes in pieces. If a slot is needed before its reader has come
/// for what is in it, that is brought home then: memory stays bounded, and nobody waits for a reader.

#include <cstddef>
#include <deque>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>

#include "kernels/backend/buffer.hpp"

namespace desert_sim {

class Readback;

/// Of the thread that owns the simulation, and of readers as far as Readback says.
class Staging {
 public:
  class Slot {
   public:
    /// Where laws write; as large as was asked for.
    char* device() const { return device_.data(); }
    /// The first `bytes` of it on the host, once they are there. Throws CudaError.
    const char* host(std::size_t bytes);

   private:
    friend class Staging;
    friend class Readback;
    using HostMemory = std::unique_ptr<char, std::function<void(char*)>>;
    void finish_reading();
    void reserve(Exec& exec, std::size_t bytes);
    void release();

    Buffer<char> device_;
    HostMemory host_;  ///< pinned; none where the device's memory is the host's
    std::unique_ptr<HostCopy> copy_;
    std::size_t sent_ = 0;
    std::shared_ptr<Readback> reader_;  ///< whose piece is in the slot
  };
  /// Called once with the slot, by whoever brings the piece home.
  using Unpack = std::function<void(Slot&)>;

  explicit Staging(Exec& exec);
  ~Staging();

  /// How large a piece should at most be [bytes].
  std::size_t slot_bytes() const { return slot_bytes_; }
  void set_slot_bytes(std::size_t bytes) { slot_bytes_ = bytes; }
  /// The memory of both slots, on the device and beside it on the host [bytes].
  std::size_t bytes() const;

  /// A slot with room for so much, which laws that are started next may write to. Throws ConfigError if there
  /// is no memory.
  Slot& acquire(std::size_t bytes);
  /// What laws have written to the slot is a piece of what `reader` waits for. Its first `bytes` are copied
  /// now, more only if `unpack` asks for more.
  void send(Slot& slot, std::size_t bytes, const std::shared_ptr<Readback>& reader, Unpack unpack);
  /// Brings everything home and gives the memory back, until it is needed again.
  void release();

 private:
  Exec* exec_;
  std::size_t slot_bytes_;
  Slot slots_[2];
  int next_slot_ = 0;
};

/// A result that is under way in pieces.
class Readback {
 public:
  /// Returns once all pieces are home, from any thread. Throws what went wrong on the way, each time.
  void wait();

 private:
  friend class Staging;
  struct Piece {
    Staging::Slot* slot;
    Staging::Unpack unpack;
  };
  void add(Piece piece);
  /// In order, up to the one in this slot; all of them if it is null.
  void read_back(const Staging::Slot* last);

  std::mutex mutex_;
  std::deque<Piece> pieces_;
  std::exception_ptr failure_;
};

/// What is known already, and values that may still be on their way.
template <class T>
class Pending {
 public:
  Pending() = default;
  Pending(std::shared_ptr<const T> value, std::shared_ptr<Readback> readback)
      : value_(std::move(value)), readback_(std::move(readback)) {}
  explicit operator bool() const { return value_ != nullptr; }
  /// Waits for the values, not for the simulation; from any thread, and also when the simulation is gone.
  /// Throws CudaError if they did not come. Null if there is nothing to wait for.
  std::shared_ptr<const T> get() const {
    if (readback_) readback_->wait();
    return value_;
  }

 private:
  std::shared_ptr<const T> value_;
  std::shared_ptr<Readback> readback_;
};

}  // namespace desert_sim
