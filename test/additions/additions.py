"""What run.py adds to a copy of the tree: a made-up process, model that moves sand, layer, topic and command, each in the
places that CONTRIBUTING.md names.

New is a file; Insert puts `text` behind `after`, which stands exactly once in `file`.
"""
import collections

New = collections.namedtuple("New", "file text")
Insert = collections.namedtuple("Insert", "file after text")
# `sections`: of CONTRIBUTING.md, whose lists name every place.
Addition = collections.namedtuple("Addition", "name sections places")

PROCESS = Addition("process", ["A process"], [
    New("kernels/soil/salt_weathering.hpp", """\
#pragma once
/// Salt breaks bare rock: rate · Δt of it becomes sand. Reads soil; writes bedrock, sand.

#include "kernels/field/layers.hpp"
#include "kernels/field/ledger.hpp"
#include "src/core/parameter_table.hpp"

namespace desert_sim {

struct SaltWeatheringParameters {
  bool enabled = false;
  float rate = 0.001f;
};
constexpr auto parameter_table(const SaltWeatheringParameters*) {
  using P = SaltWeatheringParameters;
  return std::make_tuple(
      parameter("enabled", &P::enabled, "Whether salt breaks bare rock to sand."),
      parameter("rate", &P::rate, 0, 1, "m/s", "Depth of bare rock that breaks a second."));
}
static_assert(table_is_complete<SaltWeatheringParameters>());

namespace salt_weathering {

template <class E>
void step(E& exec, const TerrainView& t, const SaltWeatheringParameters& p, float time_step, LedgerView ledger);

}  // namespace salt_weathering
}  // namespace desert_sim
"""),
    New("kernels/soil/salt_weathering.cpp", """\
/// The law and the step of salt_weathering.hpp; compiled once for each backend.
#include "kernels/soil/salt_weathering.hpp"

#include "kernels/backend/for_each.hpp"
#include "kernels/backend/loops.hpp"

namespace desert_sim::salt_weathering {

struct BreakBareRock {
  Grid grid;
  float metres, quanta_per_metre;
  const Quanta* soil;
  Quanta *bedrock, *sand;
  LedgerView ledger;

  DESERT_HD void operator()(int x, int y) const {
    const int i = grid.index(x, y);
    if (value_or_zero(soil, i) > 0 || sand[i] > 0) return;
    const Quanta broken = to_quanta_at_most(metres, quanta_per_metre, bedrock[i] + wall_height);
    bedrock[i] -= broken;
    sand[i] += broken;
    ledger.convert(Material::bedrock, Material::sand, i, broken);
  }
};

template <class E>
void step(E& exec, const TerrainView& t, const SaltWeatheringParameters& p, float time_step, LedgerView ledger) {
  for_each_cell(exec, t.grid,
                BreakBareRock{t.grid, p.rate * time_step, t.quanta_per_metre, t.quanta(Layer::soil),
                              t.quanta(Layer::bedrock), t.quanta(Layer::sand), ledger});
}

template void step(Backend&, const TerrainView&, const SaltWeatheringParameters&, float, LedgerView);

}  // namespace desert_sim::salt_weathering
"""),
    New("src/simulation/processes/weathering.cpp", """\
/// The process that breaks rock.
#include "kernels/soil/salt_weathering.hpp"
#include "src/simulation/processes/processes.hpp"

namespace desert_sim {

namespace {
const std::string section = register_section<SaltWeatheringParameters>("salt_weathering");
}

Process salt_weathering_process() {
  Process p;
  p.name = "salt_weathering";
  p.parameters = {section};
  p.source = "made up";
  p.header = "kernels/soil/salt_weathering.hpp";
  p.active = [](const Scenario& s) { return s.get<SaltWeatheringParameters>().enabled; };
  p.reads = {Layer::soil};
  p.writes = {Layer::bedrock, Layer::sand};
  p.step = [](StepContext& c, ProcessWorkspace*) {
    with_backend(c.exec(), [&](auto& e) {
      salt_weathering::step(e, c.terrain, c.scenario().get<SaltWeatheringParameters>(), c.time_step(),
                            c.state.ledger());
    });
  };
  return p;
}

}  // namespace desert_sim
"""),
    Insert("src/simulation/processes/processes.hpp", "Process soil_process();\n",
           "\nProcess salt_weathering_process();  // weathering.cpp\n"),
    Insert("src/simulation/processes/processes.cpp", " soil_process(),\n", "salt_weathering_process(),\n"),
])

SAND_MODEL = Addition("sand model", ["A process", "A model that moves sand"], [
    New("kernels/sand/march.hpp", """\
#pragma once
/// A share of the sand of each cell comes to lie in the next one to the east. Reads and writes sand.

#include "kernels/field/layers.hpp"
#include "src/core/parameter_table.hpp"

namespace desert_sim {

struct MarchParameters {
  float share = 0.1f;
};
constexpr auto parameter_table(const MarchParameters*) {
  return std::make_tuple(
      parameter("share", &MarchParameters::share, 0, 1, "1", "Of the sand that moves in a step."));
}
static_assert(table_is_complete<MarchParameters>());

namespace march {

/// `before`: the sand before the step.
template <class E>
void step(E& exec, const TerrainView& t, const MarchParameters& p, const Quanta* before);

}  // namespace march
}  // namespace desert_sim
"""),
    New("kernels/sand/march.cpp", """\
/// The law and the step of march.hpp; compiled once for each backend.
#include "kernels/sand/march.hpp"

#include "kernels/backend/for_each.hpp"
#include "kernels/backend/loops.hpp"

namespace desert_sim::march {

struct MoveEast {
  Grid grid;
  float share;
  const Quanta* before;
  Quanta* sand;

  DESERT_HD Quanta leaving(int x, int y) const {
    return x + 1 < grid.width ? static_cast<Quanta>(share * static_cast<float>(before[grid.index(x, y)])) : 0;
  }
  DESERT_HD void operator()(int x, int y) const {
    const int i = grid.index(x, y);
    sand[i] = before[i] - leaving(x, y) + (x > 0 ? leaving(x - 1, y) : 0);
  }
};

template <class E>
void step(E& exec, const TerrainView& t, const MarchParameters& p, const Quanta* before) {
  for_each_cell(exec, t.grid, MoveEast{t.grid, p.share, before, t.quanta(Layer::sand)});
}

template void step(Backend&, const TerrainView&, const MarchParameters&, const Quanta*);

}  // namespace desert_sim::march
"""),
    New("src/simulation/processes/march.cpp", """\
/// Sand that marches to the east.
#include "kernels/sand/march.hpp"

#include "src/simulation/processes/processes.hpp"

namespace desert_sim {

namespace {

const std::string section = register_section<MarchParameters>("march");

struct Workspace {
  Buffer<Quanta> before;
  std::size_t bytes() const { return before.bytes(); }
};

}  // namespace

Process march_process() {
  Process p;
  p.name = name_of(SandModel::march);
  p.parameters = {section};
  p.source = "made up";
  p.header = "kernels/sand/march.hpp";
  p.active = [](const Scenario& s) { return has_sand_model(s, SandModel::march); };
  p.roles = {Role::sand_transport};
  p.writes = {Layer::sand};
  set_workspace<Workspace>(p, [](const SimulationState& state) {
    return Workspace{Buffer<Quanta>(state.exec(), static_cast<std::size_t>(state.terrain.grid().cells()))};
  });
  p.step = [](StepContext& c, ProcessWorkspace* workspace) {
    Buffer<Quanta>& before = workspace_as<Workspace>(workspace).before;
    c.exec().copy(before.data(), c.terrain.quanta(Layer::sand), before.bytes());
    with_backend(c.exec(), [&](auto& e) {
      march::step(e, c.terrain, c.scenario().get<MarchParameters>(), before.data());
    });
  };
  return p;
}

}  // namespace desert_sim
"""),
    Insert("src/simulation/processes/processes.hpp", "Process wang_process();  // particles.cpp\n",
           "\nProcess march_process();  // march.cpp\n"),
    Insert("src/simulation/processes/processes.cpp", " wang_process(),\n", "march_process(),\n"),
    Insert("src/scenario/sand_model.hpp", "  snow,\n  wang", ",\n  march"),
    Insert("src/scenario/sand_model.hpp", '"snow", "wang"', ', "march"'),
])

LAYER = Addition("layer", ["A layer"], [
    Insert("kernels/field/layers.hpp", "  water_surface,\n  plants,\n", "  salt,\n"),
    Insert("kernels/field/layers.hpp", "constexpr std::array<LayerInfo, 44", " + 1"),
    Insert("kernels/field/layers.hpp", "from 1 on; 0 where none grows.\"},\n", """\
    {Layer::salt, "salt", "m", Storage::real, Lifetime::persistent, 0, 1, "Salt on the ground, as a depth."},
"""),
    Insert("src/simulation/processes/water.cpp",
           'p.header = "kernels/water/water_sources.hpp";\n  p.active = has_water;\n  p.writes = {Layer::water',
           ", Layer::salt"),
    Insert("src/terrain/map_layers.hpp", "constexpr std::array<MapLayer, 41", " + 1"),
    Insert("src/terrain/map_layers.hpp", '    {"normal_z", Layer::normal_z, 0.01},\n',
           '    {"salt", Layer::salt, 0.001},\n'),
])

TOPIC = Addition("topic", ["A topic"], [
    New("src/ros/topics/lowest_topic.cpp", """\
/// ~lowest: the lowest elevation of the terrain [m].
#include <std_msgs/Float32.h>

#include <algorithm>

#include "src/ros/topics/topic_list.hpp"

namespace desert_sim {

namespace {

class LowestTopic : public MessageTopic<std_msgs::Float32> {
 public:
  explicit LowestTopic(const TopicContext& context) : MessageTopic(context, "lowest") {}
  double rate() const override { return parameters().topics.lowest_rate; }
  std::vector<Layer> layers() const override { return {Layer::elevation}; }

  bool publish(const TerrainState& state) override {
    const std::vector<float>& elevation = state.snapshot->layers.at(Layer::elevation);
    std_msgs::Float32 message;
    message.data = *std::min_element(elevation.begin(), elevation.end());
    publisher_.publish(message);
    return true;
  }
};

}  // namespace

void add_lowest_topic(const TopicContext& context, TopicList& topics) {
  topics.push_back(std::make_unique<LowestTopic>(context));
}

}  // namespace desert_sim
"""),
    Insert("src/ros/topics/topic_list.hpp", "void add_wind_topics(const TopicContext& context, TopicList& topics);\n",
           "void add_lowest_topic(const TopicContext& context, TopicList& topics);\n"),
    Insert("src/ros/topics/topic_list.hpp", "  add_wind_topics(context, topics);           // ~wind, ~wind_array\n",
           "  add_lowest_topic(context, topics);         // ~lowest\n"),
    Insert("src/ros/topics/publisher_parameters.hpp", "  double wind_rate = 2;\n", "  double lowest_rate = 1;\n"),
    Insert("src/ros/topics/publisher_parameters.hpp",
           '      parameter("wind_rate", &P::wind_rate, 0, 1000, "Hz", "~wind and ~wind_array."),\n',
           '      parameter("lowest_rate", &P::lowest_rate, 0, 1000, "Hz", "~lowest."),\n'),
    Insert("config/publishers.yaml", "wind_rate: 2.0             # ~wind and ~wind_array\n", "lowest_rate: 1.0           # ~lowest\n"),
    Insert("doc/robotics/ros_interface.md",
           "| `~wind` | `desert_sim/WindField` | wind at the surface, and high above the ground |\n",
           "| `~lowest` | `std_msgs/Float32` | the lowest elevation |\n"),
])

COMMAND = Addition("command", ["A service", "A command"], [
    New("srv/Calm.srv", """\
# Lets the wind die down.

float64 ramp    # time in which it does [s of simulated time], 0 (at once) ... 1e12
---
bool success
string message  # reason if success is false
"""),
    Insert("src/ros/services/wind_services.cpp", "#include <desert_sim/EditWind.h>\n", "#include <desert_sim/Calm.h>\n"),
    Insert("src/ros/services/wind_services.cpp", "    c.publisher.status_changed();\n  };\n", """\
  services.add<Calm>("calm", [apply](const CalmRequest& request, CalmResponse&) {
    apply(command::Calm{static_cast<float>(request.ramp)});
  });
"""),
    Insert("src/simulation/commands/command.hpp", "static_assert(table_is_complete<SetWind>());\n", """\

/// No wind, reached over `ramp` seconds.
struct Calm {
  static constexpr const char* name = "calm";
  float ramp = 0;
  std::string stroke{};
};
constexpr auto parameter_table(const Calm*) {
  return std::make_tuple(parameter("ramp", &Calm::ramp, 0, 1e12, "s", "Time in which the wind dies down."),
                         parameter("stroke", &Calm::stroke, "As of edit_terrain."));
}
static_assert(table_is_complete<Calm>());
"""),
    Insert("src/simulation/commands/command.hpp", "command::LoadCheckpoint, command::LoadScenario", ", command::Calm"),
    Insert("src/simulation/editing/commands.cpp",
           "  CommandResult operator()(const command::SetWind& command) const;\n",
           "  CommandResult operator()(const command::Calm& command) const;\n"),
    Insert("src/simulation/editing/commands.cpp",
           "  regime.ramp = command.ramp;\n  return set_regime(regime, command);\n}\n", """\

CommandResult Commands::Execution::operator()(const command::Calm& command) const {
  check_ranges(command, "calm");
  WindRegime regime;
  regime.speed = 0;
  regime.ramp = command.ramp;
  return set_regime(regime, command);
}
"""),
    Insert("doc/robotics/ros_interface.md",
           "| `~set_wind` | `desert_sim/SetWind` | constant wind from now on, with an optional ramp |\n",
           "| `~calm` | `desert_sim/Calm` | no wind from now on, with an optional ramp |\n"),
    Insert("python/desert_sim/simulation.py", "        return self.call(\"set_wind\", SetWind, request)\n", """\

    def calm(self, ramp=0.0):
        \"\"\"Lets the wind die down within `ramp` [s of simulated time].\"\"\"
        return self.call("calm", Calm, ramp)
"""),
    Insert("python/desert_sim/simulation.py", "from .srv import (", "Calm, "),
])

ADDITIONS = [PROCESS, SAND_MODEL, LAYER, TOPIC, COMMAND]
