/// grid_map's filters, loaded as plugins, on ~grid_map. The node is paused on corner.yaml.
#include <filters/filter_base.hpp>
#include <grid_map_ros/grid_map_ros.hpp>
#include <pluginlib/class_loader.hpp>

#include "test/support/ros/client.hpp"

namespace {

using Filter = filters::FilterBase<grid_map::GridMap>;

grid_map::GridMap whole_map() {
  grid_map::GridMap map;
  EXPECT_TRUE(grid_map::GridMapRosConverter::fromMessage(
      node_test::Listener<grid_map_msgs::GridMap>("grid_map").last(), map));
  return map;
}

class GridMapFilters : public testing::Test {
 protected:
  /// `map` after the filter of that type, with what the parameter says.
  grid_map::GridMap filtered(const grid_map::GridMap& map, const std::string& type,
                             const std::string& parameter) {
    const auto filter = loader_.createUniqueInstance(type);
    grid_map::GridMap result;
    EXPECT_TRUE(filter->configure(parameter));
    EXPECT_TRUE(filter->update(map, result));
    return result;
  }

 private:
  /// Not static: class_loader keeps lists of its own, made when the first library is loaded, which exit()
  /// would destroy before a loader that is older than they are.
  pluginlib::ClassLoader<Filter> loader_{"filters", "filters::FilterBase<grid_map::GridMap>"};
};

TEST_F(GridMapFilters, ItsNormalsAreOurs) {
  const grid_map::GridMap map = filtered(whole_map(), "gridMapFilters/NormalVectorsFilter", "/normals");
  std::size_t compared = 0, leaning = 0;
  for (grid_map::GridMapIterator at(map); !at.isPastEnd(); ++at) {
    Eigen::Vector3d ours, theirs;
    ASSERT_TRUE(map.getVector("normal_", *at, ours));
    if (!map.getVector("filtered_", *at, theirs)) continue;  // it leaves out the outermost cells
    ++compared;
    leaning += theirs.z() < 0.99;
    EXPECT_NEAR((ours - theirs).norm(), 0, 1e-5) << at.getUnwrappedIndex().transpose();
  }
  EXPECT_EQ(compared, 62u * 46u);
  EXPECT_EQ(leaning, 14u + 10u) << "the cells at the marker's feet and its own rim";
}

TEST_F(GridMapFilters, AThresholdChangesJustWhatIsBelow) {
  const grid_map::GridMap before = whole_map();
  const grid_map::GridMap after = filtered(before, "gridMapFilters/ThresholdFilter", "/threshold");
  std::size_t below = 0;
  for (grid_map::GridMapIterator at(before); !at.isPastEnd(); ++at) {
    const float value = before.at("traversability", *at);
    below += value < 0.5f;
    EXPECT_EQ(after.at("traversability", *at), value < 0.5f ? -1.f : value);
  }
  EXPECT_GT(below, 0u);
}

}  // namespace

int main(int argc, char** argv) { return node_test::run_tests(argc, argv, "grid_map_filters"); }
