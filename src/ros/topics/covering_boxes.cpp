#include "src/ros/topics/covering_boxes.hpp"

#include <algorithm>
#include <cstddef>

namespace desert_sim {

namespace {

long cells_of(const CellBox& box) { return box.empty() ? 0 : static_cast<long>(box.width()) * box.height(); }

/// Boxes that belong to one rectangle, and the best cut of it: the first `left` boxes, sorted along `by_y`.
struct Group {
  std::vector<CellBox> boxes;
  CellBox bounds;
  long saved = 0;
  std::size_t left = 0;
  bool by_y = false;

  explicit Group(std::vector<CellBox> of) : boxes(std::move(of)) {
    for (const CellBox& box : boxes) bounds = bounds.united_with(box);
    look_for_cut(false);
    look_for_cut(true);
  }
  void sort(bool along_y) {
    std::sort(boxes.begin(), boxes.end(), [along_y](const CellBox& a, const CellBox& b) {
      return along_y ? a.y0 + a.y1 < b.y0 + b.y1 : a.x0 + a.x1 < b.x0 + b.x1;
    });
  }

 private:
  void look_for_cut(bool along_y) {
    sort(along_y);
    std::vector<CellBox> behind(boxes.size() + 1);  // bounds of all boxes from here on
    for (std::size_t i = boxes.size(); i-- > 0;) behind[i] = behind[i + 1].united_with(boxes[i]);
    CellBox before;
    for (std::size_t i = 1; i < boxes.size(); ++i) {
      before = before.united_with(boxes[i - 1]);
      const long save = cells_of(bounds) - cells_of(before) - cells_of(behind[i]);
      if (save <= saved) continue;
      saved = save;
      left = i;
      by_y = along_y;
    }
  }
};

}  // namespace

std::vector<CellBox> covering_boxes(const std::vector<CellBox>& boxes, int most, long worth) {
  std::vector<Group> groups;
  if (!boxes.empty()) groups.emplace_back(boxes);
  while (!groups.empty() && groups.size() < static_cast<std::size_t>(most)) {
    const auto best = std::max_element(groups.begin(), groups.end(),
                                       [](const Group& a, const Group& b) { return a.saved < b.saved; });
    if (best->saved == 0 || best->saved < worth) break;
    best->sort(best->by_y);
    const auto cut = best->boxes.begin() + static_cast<std::ptrdiff_t>(best->left);
    const std::vector<CellBox> first(best->boxes.begin(), cut), second(cut, best->boxes.end());
    *best = Group(first);
    groups.emplace_back(second);
  }
  std::vector<CellBox> rectangles;
  rectangles.reserve(groups.size());
  for (const Group& group : groups) rectangles.push_back(group.bounds);
  return rectangles;
}

}  // namespace desert_sim
