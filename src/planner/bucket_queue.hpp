#pragma once
/// A queue of cells by integer keys: a ring of buckets for the keys near the present one, and a list for
/// those further ahead, of which the nearest are moved into the ring when it is empty. Within a bucket the
/// last one comes first.

#include <algorithm>
#include <cstdint>
#include <limits>
#include <vector>

namespace desert_sim {

class BucketQueue {
 public:
  using Key = std::uint32_t;
  using Item = std::uint32_t;
  static constexpr Key no_key = std::numeric_limits<Key>::max();

  /// `span`: keys from the present one on that go to the ring; rounded up to a power of two.
  explicit BucketQueue(Key span) {
    Key size = 1;
    while (size < span) size *= 2;
    ring_.resize(size);
    mask_ = size - 1;
  }

  /// Empties the queue; the present key is then the least one.
  void clear() {
    if (in_ring_ > 0)
      for (std::vector<Item>& bucket : ring_) bucket.clear();
    far_.clear();
    far_least_ = no_key;
    in_ring_ = 0;
    now_ = 0;
  }
  /// A key before the present one counts as the present one.
  void push(Key key, Item item) {
    key = std::max(key, now_);
    if (key - now_ > mask_) {
      far_.push_back({key, item});
      far_least_ = std::min(far_least_, key);
      return;
    }
    ring_[key & mask_].push_back(item);
    ++in_ring_;
  }
  /// The least key there is; no_key if the queue is empty.
  Key least() {
    if (in_ring_ == 0) {
      if (far_.empty()) return no_key;
      now_ = far_least_;
    }
    while (now_ < far_least_ && ring_[now_ & mask_].empty()) ++now_;
    if (now_ == far_least_) draw_near();
    return now_;
  }
  /// One of the items with the least key. Only after least() has said that there is one.
  Item pop() {
    std::vector<Item>& bucket = ring_[now_ & mask_];
    const Item item = bucket.back();
    bucket.pop_back();
    --in_ring_;
    return item;
  }
  /// Takes out the items that are left, in any order.
  template <class Take>
  void drain(const Take& take) {
    if (in_ring_ > 0)
      for (std::vector<Item>& bucket : ring_) {
        for (const Item item : bucket) take(item);
        bucket.clear();
      }
    for (const Far& f : far_) take(f.item);
    far_.clear();
    far_least_ = no_key;
    in_ring_ = 0;
    now_ = 0;
  }

 private:
  struct Far {
    Key key;
    Item item;
  };
  /// Moves what the ring has room for from the list, now that the present key is the least one there.
  void draw_near() {
    std::size_t kept = 0;
    far_least_ = no_key;
    for (const Far& f : far_) {
      if (f.key - now_ > mask_) {
        far_[kept++] = f;
        far_least_ = std::min(far_least_, f.key);
      } else {
        ring_[f.key & mask_].push_back(f.item);
        ++in_ring_;
      }
    }
    far_.resize(kept);
  }

  std::vector<std::vector<Item>> ring_;
  Key mask_ = 0, now_ = 0;  ///< now_: no item has a smaller key
  std::size_t in_ring_ = 0;
  std::vector<Far> far_;
  Key far_least_ = no_key;  ///< of far_
};

}  // namespace desert_sim
