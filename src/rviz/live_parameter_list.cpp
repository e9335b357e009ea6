#include "src/rviz/live_parameter_list.hpp"

#include <QRegularExpression>
#include <utility>

namespace desert_sim {

namespace {

QString value_text(double value) { return QString::number(value, 'g', 9); }

/// The choices in the Python dictionary that rqt_reconfigure reads.
QStringList choices_of(const std::string& edit_method) {
  QStringList choices;
  auto found = QRegularExpression("'value': '([^']*)'").globalMatch(QString::fromStdString(edit_method));
  while (found.hasNext()) choices << found.next().captured(1);
  return choices;
}

/// Parts the description of a parameter into what it is and, in brackets at the end, its unit.
void split_unit(const std::string& description, QString& text, QString& unit) {
  const QRegularExpressionMatch match =
      QRegularExpression("^(.*) \\[([^\\]]*)\\]$").match(QString::fromStdString(description));
  text = match.hasMatch() ? match.captured(1) : QString::fromStdString(description);
  unit = match.hasMatch() ? match.captured(2) : QString();
}

}  // namespace

QString LiveParameter::tip() const {
  return text + (range.isEmpty() ? "" : "\nallowed: " + range) + (unit.isEmpty() ? "" : " " + unit);
}

std::map<std::string, QString> live_values(const dynamic_reconfigure::Config& config) {
  std::map<std::string, QString> all;
  const auto add = [&all](std::string name, const QString& value) {
    const std::size_t at = name.find("__");
    if (at != std::string::npos) all[name.replace(at, 2, ".")] = value;
  };
  for (const auto& entry : config.bools) add(entry.name, entry.value ? "true" : "false");
  for (const auto& entry : config.ints) add(entry.name, QString::number(entry.value));
  for (const auto& entry : config.doubles) add(entry.name, value_text(entry.value));
  for (const auto& entry : config.strs) add(entry.name, QString::fromStdString(entry.value));
  return all;
}

std::vector<LiveParameter> list_live_parameters(const dynamic_reconfigure::ConfigDescription& description) {
  const std::map<std::string, QString> least = live_values(description.min),
                                       most = live_values(description.max);
  std::vector<LiveParameter> parameters;
  for (const auto& group : description.groups)
    for (const auto& row : group.parameters) {
      const std::size_t at = row.name.find("__");
      if (at == std::string::npos) continue;
      LiveParameter parameter{row.name.substr(0, at), row.name.substr(at + 2), {}, {}, {}, {},
                              row.type == "bool"};
      split_unit(row.description, parameter.text, parameter.unit);
      parameter.choices = choices_of(row.edit_method);
      if (row.type == "double" || row.type == "int")
        parameter.range =
            QStringLiteral("%1 … %2").arg(least.at(parameter.path()), most.at(parameter.path()));
      parameters.push_back(std::move(parameter));
    }
  return parameters;
}

}  // namespace desert_sim
