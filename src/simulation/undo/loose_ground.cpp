#include "src/simulation/undo/loose_ground.hpp"

namespace desert_sim {

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
  at_rest_flags_ = {state_.bedrock_loose, state_.soil_loose};
  sums_ = {};
}

void LooseGround::add(std::size_t which, std::uint64_t by, LooseMark& mark) {
  sums_[which] += by;
  mark.marks[which] += by;
}

void LooseGround::painted(Layer layer, LooseMark& mark) {
  const bool bedrock = layer == Layer::bedrock;
  if (!bedrock && layer != Layer::soil) return;
  if (mark.epoch != epoch_) mark = {epoch_, {}, mark.epoch > 0};
  const std::uint64_t own = mark_of(++marks_);
  if (bedrock) add(0, own, mark);
  if (!bedrock || state_.terrain.has(Layer::soil)) add(1, own, mark);
  set_flags();
}

void LooseGround::returned(const Stroke& stroke, bool complete, LooseMark& mark) {
  const bool bedrock = stroke.changed(Layer::bedrock), soil = stroke.changed(Layer::soil);
  if (!bedrock && !soil) return;
  const bool cancels = mark.epoch == epoch_;
  const bool fresh = !complete || !cancels || mark.older;
  LooseMark now{epoch_, {}, false};
  const std::uint64_t own = fresh ? mark_of(++marks_) : 0;
  const auto turn_back = [&](std::size_t which) { add(which, own - (cancels ? mark.marks[which] : 0), now); };
  if (bedrock) turn_back(0);
  if (soil || state_.terrain.has(Layer::soil)) turn_back(1);
  mark = now;
  set_flags();
}

void LooseGround::set_flags() {
  state_.bedrock_loose = at_rest_flags_[0] || sums_[0] != 0;
  state_.soil_loose = at_rest_flags_[1] || sums_[1] != 0;
}

}  // namespace desert_sim
