#include "src/rviz/command_keys.hpp"

#include "src/simulation/commands/timed_command_names.hpp"

namespace desert_sim {

namespace {

class Keys {
 public:
  /// A key that is no parameter of a table.
  Keys& add(const char* name, const QString& text) {
    names_ << name;
    lines_ << QStringLiteral("%1: %2").arg(name, text);
    return *this;
  }
  template <class Table>
  Keys& add_table() {
    for_each_row<Table>([this](const ParameterRow& row) { add(row.name, text_of(row)); });
    return *this;
  }
  /// A key with a list of maps with the keys of a table.
  template <class Table>
  Keys& add_list(const char* name) {
    QStringList names;
    for_each_row<Table>([&names](const ParameterRow& row) { names << row.name; });
    return add(name, "a list of {" + names.join(", ") + "}");
  }
  CommandKeys all() const { return {names_.join(", "), lines_.join("\n")}; }

 private:
  template <class Table, class Visit>
  static void for_each_row(const Visit& visit) {
    std::apply([&](const auto&... rows) { (visit(rows), ...); }, table_of<Table>());
  }
  static QString text_of(const ParameterRow& row) {
    QStringList choices;
    for (int n = 0; n < row.choice_count; ++n) choices << row.choices[n];
    const bool number = choices.isEmpty() && row.unit[0] != '\0';
    const QString unit = std::string(row.unit) == "1" ? QString() : QStringLiteral(" ") + row.unit;
    const QString allowed =
        number ? QStringLiteral("%1 … %2%3").arg(row.lowest).arg(row.highest).arg(unit) : choices.join(", ");
    return allowed.isEmpty() ? row.doc : QStringLiteral("%1 (%2)").arg(row.doc, allowed);
  }

  QStringList names_, lines_;
};

}  // namespace

QStringList timed_commands() {
  QStringList names;
  for (const char* const name : timed_command_names) names << name;
  return names;
}

CommandKeys keys_of(const std::string& command) {
  const char* const points = "corners, or the ends of a capsule: [[x, y], …] [m]";
  if (command == command::SetWind::name) return Keys().add_table<command::SetWind>().all();
  if (command == command::SetWindSchedule::name)
    return Keys().add_table<WindRegimeParameters>().add_list<WindSegment>("segments").all();
  if (command == command::EditWind::name)
    return Keys()
        .add_table<command::EditWind>()
        .add_table<WindFeatureParameters>()
        .add_list<WindPathPoint>("path")
        .all();
  if (command == command::EditTerrain::name)
    return Keys().add_table<command::EditParameters>().add("points", points).all();
  return Keys().add_table<command::EditPlantsParameters>().add("points", points).all();
}

}  // namespace desert_sim
