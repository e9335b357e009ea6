#pragma once
/// Sections of parameters that processes bring along by themselves. A process whose parameters are no member
/// of Scenario registers their struct, which has a parameter table (core/parameters.hpp), and asks for it in
/// its step:
///
///     static const std::string section = register_section<FrostParameters>("frost");
///     scenario.process_sections.get<FrostParameters>("frost").rate
///
/// The section is then read, checked, written, described and changed live like all others.
/// dynamic_reconfigure does not list it; `~reload_parameters` and timelines change it.

#include <map>
#include <memory>
#include <ostream>
#include <string>
#include <vector>

#include "src/core/error.hpp"
#include "src/core/parameter_page.hpp"
#include "src/core/parameters.hpp"
#include "src/scenario/yaml_parameters.hpp"

namespace desert_sim {

class ProcessSection {
 public:
  virtual ~ProcessSection() = default;
  virtual std::unique_ptr<ProcessSection> clone() const = 0;
  virtual void read(const YAML::Node& section, const std::string& name, ValidationErrors& errors) = 0;
  virtual void emit(YAML::Emitter& out) const = 0;
  virtual void describe(std::ostream& out) const = 0;
  virtual std::vector<std::string> keys() const = 0;
};

template <class P>
class ProcessSectionOf final : public ProcessSection {
 public:
  std::unique_ptr<ProcessSection> clone() const override { return std::make_unique<ProcessSectionOf>(*this); }
  void read(const YAML::Node& section, const std::string& name, ValidationErrors& errors) override {
    yaml::read_section(section, name, errors, parameters);
  }
  void emit(YAML::Emitter& out) const override { yaml::emit_parameters(out, parameters); }
  void describe(std::ostream& out) const override { write_parameter_table(out, parameters); }
  std::vector<std::string> keys() const override {
    std::vector<std::string> keys;
    for_each_parameter(parameters, [&](const auto& row, const auto&) { keys.push_back(row.name); });
    return keys;
  }
  P parameters;
};

/// By name: every registered section, with its defaults or what the scenario says.
class ProcessSections {
 public:
  ProcessSections();
  ProcessSections(const ProcessSections& other);
  ProcessSections& operator=(const ProcessSections& other);
  ProcessSections(ProcessSections&&) = default;
  ProcessSections& operator=(ProcessSections&&) = default;

  /// Throws Error if no section of that name and type is registered.
  template <class P>
  const P& get(const std::string& name) const {
    const auto found = sections_.find(name);
    const auto* section =
        found == sections_.end() ? nullptr : dynamic_cast<const ProcessSectionOf<P>*>(found->second.get());
    if (!section) throw Error("no parameter section '" + name + "' is registered with this type");
    return section->parameters;
  }
  const std::map<std::string, std::unique_ptr<ProcessSection>>& all() const { return sections_; }

 private:
  std::map<std::string, std::unique_ptr<ProcessSection>> sections_;
};

namespace detail {
void register_section(const std::string& name, std::unique_ptr<ProcessSection> defaults);
}
/// For scenarios that are made from then on; before other threads run. Returns the name. Registering it again
/// replaces it.
template <class P>
std::string register_section(const std::string& name) {
  static_assert(table_is_complete<P>());
  detail::register_section(name, std::make_unique<ProcessSectionOf<P>>());
  return name;
}

}  // namespace desert_sim
