#include "src/simulation/undo/population.hpp"

#include <algorithm>
#include <numeric>

#include "src/simulation/undo/loose_ground.hpp"

namespace desert_sim {

namespace {

using plants::Column;

std::uint32_t word(const PlantWords& plant, Column c) { return plant[static_cast<std::size_t>(c)]; }
std::uint64_t mark_of_coming(std::uint64_t rank) { return mark_of(2 * rank); }
std::uint64_t mark_of_going(std::uint64_t rank) { return mark_of(2 * rank + 1); }

/// What of a plant never changes: its place and species.
std::uint64_t identity(const PlantWords& plant) {
  const std::uint64_t place =
      (static_cast<std::uint64_t>(word(plant, Column::x)) << 32) | word(plant, Column::y);
  return place ^ mark_of(word(plant, Column::species));
}

}  // namespace

void Population::begin() {
  words_ = plants::words(state_.plants);
  if (begun_ && steps_ == state_.steps && ranks_.size() == count()) return;
  begun_ = true;
  steps_ = state_.steps;
  first_rank_ = next_rank_;
  next_rank_ += count();
  ranks_.resize(count());
  std::iota(ranks_.begin(), ranks_.end(), first_rank_);
  blocks_.clear();
  kept_covers_ = 0;
}

void Population::forget() {
  begun_ = false;
  ranks_ = {};
  blocks_.clear();
  kept_covers_ = 0;
}

std::size_t Population::bytes() const {
  return ranks_.size() * sizeof(std::uint64_t) + kept_covers_ * sizeof(std::uint32_t);
}

PlantWords Population::plant_at(std::size_t place) const {
  PlantWords plant;
  for (std::size_t c = 0; c < plant.size(); ++c) plant[c] = words_[c * count() + place];
  return plant;
}

PlantChange Population::paint(const Edit& edit, bool remembers) {
  begin();
  PlantChange change;
  for (const std::uint32_t place : edit.removed)
    change.removed.push_back({plant_at(place), ranks_[place], mark_of_going(ranks_[place])});
  for (const PlantWords& plant : edit.added) {
    change.added.push_back({plant, next_rank_, mark_of_coming(next_rank_)});
    ++next_rank_;
  }
  std::vector<ChangedPlant> changed = change.removed;
  changed.insert(changed.end(), change.added.begin(), change.added.end());
  CoverUpdate cover = begin_cover(changed);
  replace(edit.removed, change.added);
  update_cover(cover, false, remembers);
  if (!remembers) forget();
  return change;
}

long long Population::turn_back(PlantChange& change) {
  if (change.empty()) return 0;
  begin();
  Found taken = find(change.added);
  const std::size_t capacity = static_cast<std::size_t>(state_.plants.capacity),
                    room = capacity - (count() - taken.places.size());
  PlantChange now;
  for (const ChangedPlant& plant : change.removed) {
    if (now.added.size() >= room) break;
    if (is_current(plant))
      now.added.push_back({plant.words, plant.rank, std::uint64_t{0} - plant.mark});
    else
      now.added.push_back({plant.words, next_rank_, mark_of_coming(next_rank_)}), ++next_rank_;
  }
  for (const ChangedPlant& plant : change.passed)
    if (is_current(plant)) now.passed.push_back({plant.words, plant.rank, std::uint64_t{0} - plant.mark});
  now.removed = std::move(taken.plants);
  std::vector<ChangedPlant> changed = now.removed;
  for (const auto* list : {&now.added, &now.passed})
    changed.insert(changed.end(), list->begin(), list->end());
  CoverUpdate cover = begin_cover(changed);
  replace(taken.places, now.added);
  update_cover(cover, true, true);
  const std::size_t wanted = change.added.size() + change.removed.size();
  const auto missing = static_cast<long long>(wanted - now.added.size() - now.removed.size());
  change = std::move(now);
  return missing;
}

std::vector<int> Population::leaving(const PlantChange& change) {
  if (change.added.empty()) return {};
  begin();
  std::vector<int> counts(state_.scenario.species.size(), 0);
  for (const ChangedPlant& plant : find(change.added).plants) ++counts.at(word(plant.words, Column::species));
  return counts;
}

/// Those of `wanted` that are still there: by rank, or, if a step was made since, by place and species.
Population::Found Population::find(const std::vector<ChangedPlant>& wanted) const {
  std::unordered_map<std::uint64_t, const ChangedPlant*> current;
  std::unordered_map<std::uint64_t, int> former;
  for (const ChangedPlant& plant : wanted)
    if (is_current(plant))
      current[plant.rank] = &plant;
    else
      ++former[identity(plant.words)];
  Found found;
  for (std::size_t n = 0; n < count(); ++n) {
    const PlantWords words = plant_at(n);
    std::uint64_t mark = mark_of_going(ranks_[n]);
    const auto same = current.find(ranks_[n]);
    if (same != current.end()) {
      mark = std::uint64_t{0} - same->second->mark;
    } else {
      const auto alike = former.find(identity(words));
      if (alike == former.end() || alike->second == 0) continue;
      --alike->second;
    }
    found.places.push_back(static_cast<std::uint32_t>(n));
    found.plants.push_back({words, ranks_[n], mark});
  }
  return found;
}

void Population::merge(PlantChange& stroke, PlantChange change) const {
  std::unordered_map<std::uint64_t, std::vector<std::size_t>> current, former;  // places in stroke.added
  for (std::size_t n = stroke.added.size(); n-- > 0;) {
    const ChangedPlant& plant = stroke.added[n];
    if (is_current(plant))
      current[plant.rank].push_back(n);
    else
      former[identity(plant.words)].push_back(n);
  }
  std::vector<bool> passed(stroke.added.size(), false);
  for (ChangedPlant& plant : change.removed) {
    std::vector<std::size_t>* own = nullptr;
    if (const auto same = current.find(plant.rank); same != current.end())
      own = &same->second;
    else if (const auto alike = former.find(identity(plant.words)); alike != former.end())
      own = &alike->second;
    if (!own || own->empty()) {
      stroke.removed.push_back(plant);
      continue;
    }
    const std::size_t n = own->back();
    own->pop_back();
    passed[n] = true;
    if (is_current(stroke.added[n])) stroke.passed.push_back(stroke.added[n]);
    stroke.passed.push_back(plant);
  }
  std::size_t kept = 0;
  for (std::size_t n = 0; n < passed.size(); ++n)
    if (!passed[n]) stroke.added[kept++] = stroke.added[n];
  stroke.added.resize(kept);
  stroke.added.insert(stroke.added.end(), change.added.begin(), change.added.end());
}

/// Sorts by place (the key of the look-up), and at one place by rank.
void Population::replace(const std::vector<std::uint32_t>& removed, const std::vector<ChangedPlant>& added) {
  struct Item {
    int key;
    std::uint64_t rank;
    std::size_t place;  ///< of those that stay, or count() + number in `added`
    bool operator<(const Item& other) const { return key != other.key ? key < other.key : rank < other.rank; }
  };
  const auto key = [this](const PlantWords& plant) {
    return state_.plants.lookup.key(float_from_bits(word(plant, Column::x)),
                                    float_from_bits(word(plant, Column::y)),
                                    float_from_bits(word(plant, Column::radius)));
  };
  std::vector<Item> stay, come, all;
  auto gone = removed.begin();
  for (std::size_t n = 0; n < count(); ++n) {
    if (gone != removed.end() && *gone == n)
      ++gone;
    else
      stay.push_back({key(plant_at(n)), ranks_[n], n});
  }
  for (std::size_t n = 0; n < added.size(); ++n)
    come.push_back({key(added[n].words), added[n].rank, count() + n});
  std::sort(come.begin(), come.end());
  std::merge(stay.begin(), stay.end(), come.begin(), come.end(), std::back_inserter(all));
  std::vector<std::uint32_t> words(all.size() * plants::column_count);
  std::vector<std::uint64_t> ranks;
  for (std::size_t n = 0; n < all.size(); ++n) {
    const PlantWords plant =
        all[n].place < count() ? plant_at(all[n].place) : added[all[n].place - count()].words;
    for (std::size_t c = 0; c < plant.size(); ++c) words[c * all.size() + n] = plant[c];
    ranks.push_back(all[n].rank);
  }
  state_.set_plants(words);
  words_ = std::move(words);
  ranks_ = std::move(ranks);
}

}  // namespace desert_sim
