// The same commands, seed and ground give the same bits: again, after a save, and from the journal.

#include "src/rover/journal.hpp"

#include <set>

#include "src/rover/simulated_ground.hpp"
#include "src/rover/state_file.hpp"
#include "src/rover/urdf.hpp"
#include "test/src/rover/field.hpp"
#include "test/support/refusal.hpp"
#include "test/support/temporary_folder.hpp"
#include "test/support/world.hpp"

namespace desert_sim {
namespace {

using namespace test;

const char* const dunes =
    "{seed: 5, grid: {width: 48, height: 48, cell_size: 0.5, boundary: open}, wind: {speed: 9, "
    "direction_deg: 20},"
    " terrain: [noise: {layer: sand, low: 0.2, high: 1.5, scale: 6}]}";

SimulatedGround living_ground(bool micro_relief = false) {
  return SimulatedGround(scenario_of(dunes), no_raster_loader, "cpu", 1, micro_relief);
}

RoverParameters noisy() {
  RoverParameters p;
  p.suspension = SuspensionKind::rocker_bogie;
  p.odometry_noise = 0.02;
  p.gyro_noise = 0.01;
  p.seed = 11;
  return p;
}

std::vector<RoverEvent> course() {
  std::vector<RoverEvent> events{rover_event::Place{10, 12, 0.3, true, 0}};
  for (std::uint64_t step = 1; step <= 30; ++step) {
    if (step % 5 == 1)
      events.push_back(rover_event::Drive{{0.25, 0, step % 2 ? 0.2 : -0.3}, step % 3 ? 2.5 : 100.0});
    events.push_back(rover_event::Advance{0.333, step, static_cast<double>(step)});
  }
  return events;
}

/// The hash of the states after each event; a rover that went through the first `begin` events is handed
/// over.
std::vector<std::uint64_t> path(Rover& rover, const std::vector<RoverEvent>& events, std::size_t begin,
                                std::size_t end, bool micro_relief = false) {
  SimulatedGround ground = living_ground(micro_relief);
  std::vector<std::uint64_t> hashes;
  for (std::size_t n = begin; n < end; ++n) {
    apply(rover, events[n], [&](std::uint64_t step) -> const GroundSource& { return ground.at(step); });
    hashes.push_back(hash_of(rover.state()));
  }
  return hashes;
}

TEST(RoverRepeat, TwoRunsAreOneToTheBit) {
  const std::vector<RoverEvent> events = course();
  Rover a(noisy(), {}), b(noisy(), {});
  const auto first = path(a, events, 0, events.size());
  EXPECT_EQ(path(b, events, 0, events.size()), first);
  EXPECT_GT(a.state().way_made, 0.5) << a.state().reason;
  RoverParameters other = noisy();
  other.seed = 12;
  Rover c(other, {});
  EXPECT_NE(path(c, events, 0, events.size()), first);
}

TEST(RoverRepeat, ASavedRoverGoesOnToTheBit) {
  const TemporaryFolder folder;
  const std::vector<RoverEvent> events = course();
  Rover whole(noisy(), {}), before(noisy(), {}), after(noisy(), {});
  auto expected = path(whole, events, 0, events.size());
  path(before, events, 0, 17);
  save_rover(folder.path("rover"), before);
  load_rover(folder.path("rover"), after);
  EXPECT_EQ(hash_of(after.state()), hash_of(before.state()));
  EXPECT_EQ(rover_state_bytes(after), rover_state_bytes(before));
  expected.erase(expected.begin(), expected.begin() + 17);
  EXPECT_EQ(path(after, events, 17, events.size()), expected);
}

TEST(RoverRepeat, TheJournalLeadsToTheSameState) {
  const TemporaryFolder folder;
  const std::vector<RoverEvent> events = course();
  std::set<std::uint64_t> ends;
  for (const bool micro_relief : {false, true}) {
    Rover rover(noisy(), {});
    path(rover, events, 0, events.size(), micro_relief);
    {
      RoverJournalWriter journal(folder.path("journal"), rover, micro_relief);
      for (const RoverEvent& event : events) journal.write(event);
      Rover other(noisy(), {});
      path(other, events, 0, 9, micro_relief);
      journal.write(rover_event::SetState{rover_state_bytes(other)});
      journal.write(rover_event::SetState{rover_state_bytes(rover)});
    }
    const RoverJournal journal = read_rover_journal(folder.path("journal"));
    SimulatedGround ground = living_ground(journal.micro_relief);
    const RoverState end =
        replay(journal, [&](std::uint64_t step) -> const GroundSource& { return ground.at(step); });
    EXPECT_EQ(hash_of(end), hash_of(rover.state()));
    EXPECT_EQ(end.pose.x, rover.state().pose.x);
    ends.insert(hash_of(end));
  }
  EXPECT_EQ(ends.size(), 2u) << "it drove over ripples, or over none";
}

TEST(RoverRepeat, AJournalOfAnOlderVersionHasNoMicroRelief) {
  const TemporaryFolder folder;
  { RoverJournalWriter(folder.path("journal"), Rover(noisy(), {}), true); }
  std::string text = file_bytes(folder.path("journal"));
  EXPECT_TRUE(read_rover_journal(folder.path("journal")).micro_relief);
  text.replace(text.find("micro_relief: true, "), std::string("micro_relief: true, ").size(), "");
  folder.write("older", text);
  EXPECT_FALSE(read_rover_journal(folder.path("older")).micro_relief);
}

/// What moisture makes of the ground is part of the rover: its states and journals have it, unless it is the
/// default, which those of earlier versions lack.
TEST(RoverRepeat, OnOtherWetGroundItIsAnotherRover) {
  const TemporaryFolder folder;
  const Rover usual(noisy(), {}), firm(noisy(), {}, "rover", {3, 1.25});
  EXPECT_EQ(usual.text().find("wet_ground"), std::string::npos);
  EXPECT_NE(firm.text().find("half_wet: 3"), std::string::npos) << firm.text();
  { RoverJournalWriter(folder.path("journal"), firm, false); }
  const RoverJournal journal = read_rover_journal(folder.path("journal"));
  EXPECT_EQ(journal.wet_ground.half_wet, 3);
  EXPECT_EQ(journal.wet_ground.saturated, 1.25);
  { RoverJournalWriter(folder.path("usual"), usual, false); }
  EXPECT_EQ(read_rover_journal(folder.path("usual")).wet_ground.half_wet, 1.5);
  folder.write("state", rover_state_bytes(firm));
  folder.write("usual_state", rover_state_bytes(usual));
  Rover wet = firm, dry = usual;
  EXPECT_NE(
      refusal([&] { load_rover(folder.path("state"), dry); }).find("wet_ground:', which this rover has not"),
      std::string::npos);
  EXPECT_NE(
      refusal([&] { load_rover(folder.path("usual_state"), wet); }).find("wet_ground:', which it has not"),
      std::string::npos);
  load_rover(folder.path("state"), wet);
}

TEST(RoverRepeat, AJournalThatWasCutOffIsReadUpToThere) {
  const TemporaryFolder folder;
  const std::string path = folder.path("journal");
  {
    const Rover rover(noisy(), {});
    RoverJournalWriter journal(path, rover, false);
    for (const RoverEvent& event : course()) journal.write(event);
  }
  const std::string bytes = file_bytes(path);
  const std::size_t events = course().size();
  EXPECT_EQ(read_rover_journal(path).events.size(), events);
  folder.write("cut", bytes.substr(0, bytes.size() - 3));
  EXPECT_EQ(read_rover_journal(folder.path("cut")).events.size(), events - 1);
  folder.write("bad", bytes + "{fly: 3}\n");
  EXPECT_NE(
      refusal([&] { read_rover_journal(folder.path("bad")); }).find("bad:" + std::to_string(events + 2)),
      std::string::npos);
  for (const char* state :
       {"!!binary \"\xC3\xA4\xC3\xB6\"", "!!binary \"a b\"", "!!binary \"%%%%\"", "[1]"}) {
    folder.write("state", bytes + "{state: " + state + "}\n");
    const std::string said = refusal([&] { read_rover_journal(folder.path("state")); });
    EXPECT_NE(said.find("state:" + std::to_string(events + 2)), std::string::npos) << state << ": " << said;
  }
  folder.write("other", "{journal: 1}\n");
  EXPECT_NE(refusal([&] { read_rover_journal(folder.path("other")); }).find("not the journal of a rover"),
            std::string::npos);
}

TEST(RoverRepeat, BadFilesAreRefusedAndChangeNothing) {
  const TemporaryFolder folder;
  Rover rover(noisy(), {});
  path(rover, course(), 0, 12);
  const std::string bytes = rover_state_bytes(rover);
  const std::uint64_t hash = hash_of(rover.state());
  const auto refused = [&](const std::string& name, const std::string& content, const std::string& word) {
    folder.write(name, content);
    const std::string reason = refusal([&] { load_rover(folder.path(name), rover); });
    EXPECT_NE(reason.find(word), std::string::npos) << name << ": " << reason;
    EXPECT_EQ(hash_of(rover.state()), hash);
  };
  refused("empty", "", "is not the state of a rover");
  refused("other", "desert_sim checkpoint\n", "is not the state of a rover");
  for (std::size_t length = 17; length < bytes.size(); length += 37)
    refused("cut", bytes.substr(0, length), "trunca");
  std::string flipped = bytes;
  flipped[bytes.size() / 2] = static_cast<char>(flipped[bytes.size() / 2] ^ 4);
  refused("flipped", flipped, "checksum");
  refused("large", bytes + std::string(1 << 17, 'x'), "at most");
  EXPECT_NE(refusal([&] { load_rover(folder.path("missing"), rover); }).find("missing"), std::string::npos);

  Rover small = rover_of();
  folder.write("right", bytes);
  EXPECT_NE(refusal([&] { load_rover(folder.path("right"), small); }).find("suspension"), std::string::npos);

  RoverState broken = rover.state();
  broken.pose.z = NAN;
  Rover writer(noisy(), {});
  writer.set_state(broken);
  refused("nan", rover_state_bytes(writer), "pose");
  broken = rover.state();
  broken.wheels[2].sunk = -1;
  writer.set_state(broken);
  refused("negative", rover_state_bytes(writer), "sinkage");
}

TEST(RoverModel, HasEveryJointOnce) {
  for (const SuspensionKind suspension : {SuspensionKind::rocker, SuspensionKind::rocker_bogie})
    for (const Steering steering : {Steering::skid, Steering::ackermann, Steering::per_wheel}) {
      RoverParameters p;
      p.suspension = suspension;
      p.steering = steering;
      const std::string urdf = urdf_of(p, LidarParameters(), DepthCameraParameters(), "r1/");
      const auto joints = joint_values(p, RoverState());
      const std::size_t wheels = static_cast<std::size_t>(wheel_count(suspension));
      EXPECT_EQ(joints.size(), (wheels == 6 ? 4 : 2) + wheels * (steering == Steering::skid ? 1 : 2));
      for (const JointValue& joint : joints) {
        const std::string name = "<joint name=\"" + joint.name + "\"";
        const std::size_t at = urdf.find(name);
        EXPECT_NE(at, std::string::npos) << joint.name;
        EXPECT_EQ(urdf.find(name, at + 1), std::string::npos) << joint.name;
      }
      EXPECT_NE(urdf.find("link=\"r1/base_link\""), std::string::npos);
    }
}

TEST(RoverModel, HasTheSensorsThatMeasure) {
  LidarParameters lidar;
  DepthCameraParameters camera;
  const auto has = [&](const char* link) {
    return urdf_of(RoverParameters(), lidar, camera, "r1/")
               .find("<link name=\"r1/" + std::string(link) + "\"") != std::string::npos;
  };
  EXPECT_TRUE(has("lidar") && has("depth_camera") && has("depth_camera_optical"));
  lidar.rate = 0;
  EXPECT_TRUE(!has("lidar") && has("depth_camera_optical"));
  camera.rate = 0;
  EXPECT_FALSE(has("depth_camera") || has("depth_camera_optical"));
}

TEST(RoverGround, KnowsLoosenessWhereSomethingIsLoose) {
  const auto looseness_at_start = [](const char* looseness) {
    SimulatedGround ground(scenario_of(std::string("{grid: {width: 16, height: 16}, terrain: [uniform: "
                                                   "{layer: sand, value: 1}]") +
                                       looseness + "}"),
                           no_raster_loader, "cpu", 1);
    return ground.at(0).at(5, 5).looseness;
  };
  EXPECT_FALSE(looseness_at_start("").has_value());
  const std::optional<double> loose = looseness_at_start(", looseness: {enabled: true}");
  ASSERT_TRUE(loose.has_value());
  EXPECT_GT(*loose, 0);
}

}  // namespace
}  // namespace desert_sim
