// Strokes, undo and redo on both backends: the same bits.

#include "src/simulation/session.hpp"
#include "test/support/strokes.hpp"

namespace desert_sim {
namespace {

class UndoParity : public test::OnBoth {};

/// What either backend makes of a command: the hash after it, or why it was refused.
std::string outcome(Session& session, const Command& command) {
  try {
    session.apply(command);
    return std::to_string(session.simulation().state().hash());
  } catch (const ConfigError& e) {
    return e.what();
  }
}

TEST_F(UndoParity, OfRandomStrokes) {
  for (const char* world : test::undo_worlds) {
    const Scenario scenario = test::scenario_of(test::undo_world(world));
    Session a(scenario, no_raster_loader, "cpu", 2), b(scenario, no_raster_loader, "cuda", 2);
    test::RandomStrokes random(a.simulation(), 9);
    for (int n = 0; n < 120; ++n) {
      const std::string name(1, static_cast<char>('a' + random.below(4)));
      const std::size_t which = random.below(5);
      const Command command = which == 0 ? Command(command::Undo{name})
                                         : (which == 1 ? Command(command::Redo{}) : random.next(name));
      ASSERT_EQ(outcome(a, command), outcome(b, command)) << world << ", " << n;
    }
  }
}

}  // namespace
}  // namespace desert_sim
