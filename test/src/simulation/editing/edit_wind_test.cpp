// Local features of the wind that come, change and go while the simulation runs.

#include <cmath>
#include <limits>

#include "src/simulation/checkpoint.hpp"
#include "test/support/temporary_folder.hpp"
#include "test/support/world.hpp"

namespace desert_sim {
namespace {

const std::string grid =
    "grid: {width: 40, height: 32, cell_size: 2, origin_x: 100, origin_y: -50, boundary: open}\n"
    "terrain: [uniform: {layer: sand, value: 2}]\n";
const std::string plain = grid + "wind: {speed: 5}\n";
const std::string with_vortex =
    grid + "wind: {speed: 5, features: [{kind: vortex, x: 140, y: -20, radius: 8, speed: 6, id: 7}]}\n";

command::EditWind vortex(WindEdit operation, float speed = 6) {
  command::EditWind edit;
  edit.operation = operation;
  edit.feature.id = 7;
  edit.feature.x = 140;
  edit.feature.y = -20;
  edit.feature.radius = 8;
  edit.feature.speed = speed;
  return edit;
}

class EditWind : public test::OnBackend {
 protected:
  std::uint64_t hash_after(Simulation& s, int steps) {
    test::run(s, steps);
    return s.state().hash();
  }
};

TEST_P(EditWind, AddedBeforeTheFirstStepIsAsIfTheScenarioHadIt) {
  auto added = simulation(plain), given = simulation(with_vortex);
  added->apply(vortex(WindEdit::add));
  EXPECT_EQ(hash_after(*added, 5), hash_after(*given, 5));
}

TEST_P(EditWind, RemovedOrClearedIsAsIfItHadNeverBeen) {
  for (WindEdit operation : {WindEdit::remove, WindEdit::clear}) {
    auto removed = simulation(with_vortex), none = simulation(plain);
    removed->apply(vortex(operation));
    EXPECT_EQ(hash_after(*removed, 5), hash_after(*none, 5));
  }
}

TEST_P(EditWind, AVortexTurnsTheWindAroundIt) {
  auto s = simulation(plain);
  test::run(*s, 1);
  s->apply(vortex(WindEdit::add));
  s->apply(vortex(WindEdit::change, -3));
  test::run(*s, 1);
  const std::vector<float> u = s->terrain().values(Layer::wind_x);
  // Clockwise by 3 m/s, fastest 8 m (4 cells) from (140, -20), which is the corner of cells 19 and 20, 14
  // and 15.
  const auto at = [&](int x, int y) { return static_cast<double>(u[static_cast<std::size_t>(y * 40 + x)]); };
  EXPECT_NEAR(at(20, 18) - at(20, 11), 6, 0.4);
  EXPECT_NEAR(at(20, 18) + at(20, 11), 10, 0.4) << "about the wind of 5 m/s";
}

/// A feature that comes and goes by itself, as if somebody had added and removed it at those times.
TEST_P(EditWind, BeginsAndEndsByTheSimulatedTime) {
  const test::TemporaryFolder folder;
  command::EditWind timed = vortex(WindEdit::add);
  timed.feature.begin = 3;
  timed.feature.end = 6;
  auto s = simulation(plain), edited = simulation(plain);
  s->apply(timed);
  test::run(*s, 2);
  save_checkpoint(folder.path("a"), *s);
  auto loaded = load_checkpoint(folder.path("a"), exec());
  for (int step = 3; step <= 9; ++step) {
    SCOPED_TRACE(step);
    if (step == 3) test::run(*edited, 2);
    test::run(*s, 1), test::run(*loaded, 1);
    if (step == 4) edited->apply(vortex(WindEdit::add));  // the fourth step is that from 3 s on
    if (step == 7) edited->apply(vortex(WindEdit::remove));
    EXPECT_EQ(loaded->state().hash(), hash_after(*edited, 1));
    EXPECT_EQ(loaded->state().hash(), s->state().hash());
  }
}

TEST_P(EditWind, MovesWithItsVelocity) {
  command::EditWind moving = vortex(WindEdit::add);
  moving.feature.velocity_x = 2;
  auto s = simulation(plain), edited = simulation(plain);
  s->apply(moving);
  command::EditWind standing = vortex(WindEdit::add);
  for (int second = 0; second < 5; ++second) {
    standing.feature.x = 140 + 2 * second;
    edited->apply(standing);
    standing.operation = WindEdit::change;
    EXPECT_EQ(hash_after(*s, 1), hash_after(*edited, 1)) << second;
  }
}

/// Around a corner, and from a checkpoint and from a scenario that is saved on the way, too.
TEST_P(EditWind, FollowsItsPath) {
  const test::TemporaryFolder folder;
  command::EditWind on_path = vortex(WindEdit::add);
  on_path.feature.x = on_path.feature.y = 0;
  on_path.feature.path = {{1, 140, -20}, {3, 144, -20}, {5, 144, -14}};
  auto s = simulation(plain), edited = simulation(plain);
  s->apply(on_path);
  EXPECT_EQ(test::parsed(dump_scenario(s->scenario())).wind_features.at(0).path.at(2).y, -14);
  command::EditWind standing = vortex(WindEdit::add);
  const double x[] = {140, 140, 142, 144, 144, 144, 144}, y[] = {-20, -20, -20, -20, -17, -14, -14};
  for (int second = 0; second < 7; ++second) {
    standing.feature.x = x[second];
    standing.feature.y = y[second];
    edited->apply(standing);
    standing.operation = WindEdit::change;
    EXPECT_EQ(hash_after(*s, 1), hash_after(*edited, 1)) << second;
    if (second == 2) {
      save_checkpoint(folder.path("a"), *s);
      s = load_checkpoint(folder.path("a"), exec());
    }
  }
}

TEST_P(EditWind, IsInACheckpoint) {
  const test::TemporaryFolder folder;
  auto s = simulation(plain);
  test::run(*s, 2);
  s->apply(vortex(WindEdit::add));
  save_checkpoint(folder.path("a"), *s);
  auto loaded = load_checkpoint(folder.path("a"), exec());
  EXPECT_EQ(hash_after(*loaded, 3), hash_after(*s, 3));
  loaded->apply(vortex(WindEdit::remove));
}

TEST_P(EditWind, RefusesAndChangesNothing) {
  auto s = simulation(with_vortex), untouched = simulation(with_vortex);
  const auto refused = [&](const command::EditWind& edit, const std::string& naming) {
    try {
      s->apply(edit);
      ADD_FAILURE() << "was not refused: " << naming;
    } catch (const ConfigError& e) {
      EXPECT_NE(std::string(e.what()).find(naming), std::string::npos) << e.what();
    }
  };
  refused(vortex(WindEdit::add), "id: 7 is already the id of another feature");
  command::EditWind edit = vortex(WindEdit::change);
  edit.feature.id = 8;
  refused(edit, "id: 8 is not the id of any feature");
  edit.operation = WindEdit::remove;
  refused(edit, "id: 8 is not the id of any feature");
  edit.feature.id = 0;
  refused(edit, "id: 0 must be 1 or more");
  edit = vortex(WindEdit::change);
  edit.feature.radius = 0;
  refused(edit, "radius");
  edit.feature.radius = std::numeric_limits<float>::quiet_NaN();
  refused(edit, "radius");
  edit = vortex(WindEdit::change);
  edit.feature.begin = 5;
  edit.feature.end = 4;
  refused(edit, "end: must be above `begin`");
  edit = vortex(WindEdit::change);
  edit.feature.path = {{1, 0, 0}, {2, 0, 0}};
  refused(edit, "x: is given beside `path`");
  edit.feature.x = edit.feature.y = 0;
  edit.feature.path[1].time = 0.5;
  refused(edit, "path.1.time: 0.5 s is not after the 1 s");
  edit.feature.path[1] = {2, 2e9, 0};
  refused(edit, "path.1: x");
  edit.feature.path.pop_back();
  refused(edit, "path: 1 points");
  edit = vortex(WindEdit::add);
  for (int id = 8; id < 8 + static_cast<int>(max_wind_features) - 1; ++id) {
    edit.feature.id = id;
    edit.feature.speed = 0;
    s->apply(edit);
  }
  edit.feature.id = 1000;
  refused(edit, "64 features already");
  EXPECT_EQ(hash_after(*s, 3), hash_after(*untouched, 3)) << "features of speed 0 change nothing";
}

DESERT_ON_EACH_BACKEND(EditWind);

}  // namespace
}  // namespace desert_sim
