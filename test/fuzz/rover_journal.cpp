// Journals of rovers: one that is accepted is replayed on a small terrain. Input without a header gets that
// of a rover as it is by default.
#include "src/core/files.hpp"
#include "src/rover/journal.hpp"
#include "src/rover/simulated_ground.hpp"
#include "test/fuzz/fuzz.hpp"
#include "test/support/small_scenarios.hpp"
#include "test/support/temporary_folder.hpp"

namespace desert_sim {
namespace {

constexpr std::uint64_t last_step = 3;
constexpr double longest_drive = 10;  // [s] in all, which take a few milliseconds

std::string default_header() {
  const test::TemporaryFolder folder;
  const std::string path = folder.path("journal");
  { const RoverJournalWriter writer(path, Rover(RoverParameters(), {}, "fuzz"), false); }
  return read_file(path);
}

SimulatedGround small_ground() {
  Scenario scenario = parse_scenario_text(test::small_desert, "fuzz");
  resolve_grid(scenario, no_raster_loader);
  return {std::move(scenario), no_raster_loader, "cpu", 1};
}

bool is_short(const RoverJournal& journal) {
  double seconds = 0;
  for (const RoverEvent& event : journal.events)
    if (const auto* advance = std::get_if<rover_event::Advance>(&event)) seconds += advance->seconds;
  return !(seconds > longest_drive);
}

}  // namespace
}  // namespace desert_sim

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace desert_sim;
  static const std::string header = default_header();
  static SimulatedGround ground = small_ground();
  std::string text(reinterpret_cast<const char*>(data), size);
  if (text.rfind("{rover_journal", 0) != 0) text.insert(0, header);
  const fuzz::MemoryFile file(text.data(), text.size());
  return fuzz::accept_or_refuse([&] {
    const RoverJournal journal = read_rover_journal(file.path());
    if (!is_short(journal)) return;
    replay(journal, [](std::uint64_t step) -> const GroundSource& {
      if (step > last_step) throw ConfigError("beyond the last step");
      return ground.at(step);
    });
  });
}
