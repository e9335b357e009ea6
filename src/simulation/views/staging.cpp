#include "src/simulation/views/staging.hpp"

#include <algorithm>

#include "src/core/error.hpp"
#include "src/core/log.hpp"

namespace desert_sim {

// ---- a slot

const char* Staging::Slot::host(std::size_t bytes) {
  char* const to = host_ ? host_.get() : device_.data();
  copy_->wait();
  if (bytes > sent_) copy_->fetch(to + sent_, device_.data() + sent_, bytes - sent_);
  sent_ = std::max(sent_, bytes);
  return to;
}

void Staging::Slot::finish_reading() {
  if (reader_) reader_->read_back(this);
  reader_.reset();
}

void Staging::Slot::reserve(Exec& exec, std::size_t bytes) {
  if (device_.size() >= bytes) return;
  release();
  device_ = Buffer<char>(exec, bytes);
  if (exec.shares_memory()) return;
  try {
    host_ = HostMemory(static_cast<char*>(exec.allocate_host(bytes)),
                       [&exec](char* memory) { exec.release_host(memory); });
  } catch (...) {
    device_ = {};
    throw;
  }
}

void Staging::Slot::release() {
  if (copy_) copy_->wait();  // of which nobody may have wanted to know any more
  copy_.reset();
  host_.reset();
  device_ = {};
}

// ---- both

namespace {
/// Four layers of 4096 × 4096 cells; where it takes memory of the host twice, of 2048 × 2048.
constexpr std::size_t bytes_on_device = std::size_t{256} << 20, bytes_if_shared = std::size_t{64} << 20;
}  // namespace

Staging::Staging(Exec& exec)
    : exec_(&exec), slot_bytes_(exec.shares_memory() ? bytes_if_shared : bytes_on_device) {}

Staging::~Staging() {
  try {
    release();
  } catch (const Error& e) {
    log_error(e.what());
  }
}

std::size_t Staging::bytes() const {
  std::size_t total = 0;
  for (const Slot& slot : slots_) total += slot.device_.size();
  return total;
}

Staging::Slot& Staging::acquire(std::size_t bytes) {
  Slot& slot = slots_[next_slot_];
  next_slot_ = 1 - next_slot_;
  slot.finish_reading();
  slot.reserve(*exec_, bytes);
  if (slot.copy_) exec_->wait_on_device_for(*slot.copy_);
  return slot;
}

void Staging::send(Slot& slot, std::size_t bytes, const std::shared_ptr<Readback>& reader, Unpack unpack) {
  char* const to = slot.host_ ? slot.host_.get() : slot.device_.data();
  slot.copy_ = exec_->start_download(to, slot.device_.data(), bytes);
  slot.sent_ = bytes;
  slot.reader_ = reader;
  reader->add({&slot, std::move(unpack)});
}

void Staging::release() {
  for (Slot& slot : slots_) slot.finish_reading();
  for (Slot& slot : slots_) slot.release();
}

// ---- what a reader waits for

void Readback::add(Piece piece) {
  const std::lock_guard<std::mutex> lock(mutex_);
  pieces_.push_back(std::move(piece));
}

void Readback::wait() {
  read_back(nullptr);
  const std::lock_guard<std::mutex> lock(mutex_);
  if (failure_) std::rethrow_exception(failure_);
}

void Readback::read_back(const Staging::Slot* last) {
  const std::lock_guard<std::mutex> lock(mutex_);
  const bool waits = std::any_of(pieces_.begin(), pieces_.end(),
                                 [last](const Piece& piece) { return !last || piece.slot == last; });
  while (waits && !pieces_.empty()) {
    const Piece piece = std::move(pieces_.front());
    pieces_.pop_front();
    try {
      if (!failure_) piece.unpack(*piece.slot);
    } catch (...) {
      failure_ = std::current_exception();
    }
    if (piece.slot == last) break;
  }
}

}  // namespace desert_sim
