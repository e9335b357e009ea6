#pragma once
/// The parameters of a scenario that can change while it runs, as a node describes them
/// (~parameter_descriptions): names, units, ranges and choices are those of its parameter tables.

#include <dynamic_reconfigure/ConfigDescription.h>

#include <QString>
#include <QStringList>
#include <map>
#include <string>
#include <vector>

namespace desert_sim {

struct LiveParameter {
  std::string section, name;  ///< "rain", "rate"
  QString text, unit, range;  ///< `text`: what it is
  QStringList choices;        ///< empty: any text or number
  bool is_switch = false;
  std::string path() const { return section + "." + name; }
  /// What it is, and what is allowed.
  QString tip() const;
};

/// Without those of the node, which are of no section.
std::vector<LiveParameter> list_live_parameters(const dynamic_reconfigure::ConfigDescription& description);

/// The values of all parameters with a section, by path.
std::map<std::string, QString> live_values(const dynamic_reconfigure::Config& config);

}  // namespace desert_sim
