#include "src/simulation/undo/loose_ground.hpp"

#include <algorithm>
#include <iterator>

namespace desert_sim {

namespace {
constexpr Layer sliding_layers[] = {Layer::bedrock, Layer::soil};
}

std::uint64_t mark_of(std::uint64_t count) {  // splitmix64, by Sebastiano Vigna
  std::uint64_t z = (count + 1) * 0x9e3779b97f4a7c15ULL;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
  return z ^ (z >> 31);
}

void LooseGround::begin() {
  if (epoch_ > 0 && steps_ == state_.steps) return;
  ++epoch_;
  steps_ = state_.steps;
  at_rest_flags_ = state_.flags;
  sums_ = {};
}

void LooseGround::add(std::size_t which, std::uint64_t by, LooseMark& mark) {
  sums_[which] += by;
  mark.marks[which] += by;
}

void LooseGround::painted(Layer layer, LooseMark& mark) {
  const auto* const which = std::find(std::begin(sliding_layers), std::end(sliding_layers), layer);
  if (which == std::end(sliding_layers)) return;
  if (mark.epoch != epoch_) mark = {epoch_, {}, mark.epoch > 0};
  add(static_cast<std::size_t>(which - sliding_layers), mark_of(++marks_), mark);
  set_flags();
}

void LooseGround::returned(const Stroke& stroke, bool complete, LooseMark& mark) {
  if (!stroke.changed(Layer::bedrock) && !stroke.changed(Layer::soil)) return;
  const bool cancels = mark.epoch == epoch_;
  const bool fresh = !complete || !cancels || mark.older;
  LooseMark now{epoch_, {}, false};
  const std::uint64_t own = fresh ? mark_of(++marks_) : 0;
  for (std::size_t which = 0; which < sums_.size(); ++which)
    if (stroke.changed(sliding_layers[which])) add(which, own - (cancels ? mark.marks[which] : 0), now);
  mark = now;
  set_flags();
}

void LooseGround::set_flags() {
  state_.flags = at_rest_flags_;
  for (std::size_t which = 0; which < sums_.size(); ++which)
    if (sums_[which] != 0) pipeline_.edited(sliding_layers[which]);
}

}  // namespace desert_sim
