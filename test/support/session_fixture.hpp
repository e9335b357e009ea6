#pragma once
/// What tests of undo ask of a session.

#include <string>

#include "src/core/error.hpp"
#include "src/simulation/checkpoint.hpp"
#include "src/simulation/session.hpp"
#include "test/support/strokes.hpp"
#include "test/support/temporary_folder.hpp"
#include "test/support/world.hpp"

namespace desert_sim::test {

/// Sessions of the worlds for undo on each backend.
class OnSession : public OnBackend {
 protected:
  std::unique_ptr<Session> session(const std::string& world, const std::string& journal = "",
                                   std::size_t memory = default_undo_memory) {
    return std::make_unique<Session>(scenario_of(undo_world(world)), no_raster_loader, GetParam(), 1, journal,
                                     memory);
  }
  static void steps(Session& s, int n) {
    for (; n > 0; --n) s.step();
  }
  static std::string bytes(Session& s) { return checkpoint_bytes(s.simulation()); }
  static bool accepted(Session& s, const Command& command) {
    try {
      s.apply(command);
      return true;
    } catch (const ConfigError&) {
      return false;
    }
  }
  /// Why the command is refused; a failure if it is not, or if it changes a byte of the checkpoint.
  static std::string refusal(Session& s, const Command& command) {
    const std::string before = bytes(s);
    std::string reason;
    try {
      s.apply(command);
      ADD_FAILURE() << "was accepted";
    } catch (const ConfigError& e) {
      reason = e.what();
    }
    EXPECT_TRUE(bytes(s) == before) << "a refusal has changed something: " << reason;
    return reason;
  }

  TemporaryFolder folder_;
};

}  // namespace desert_sim::test
