#pragma once
/// The sections of a scenario that processes bring along. A section is a struct with a parameter table
/// (core/parameter_table.hpp); who reads it registers it, and gets it by its type:
///
///     const std::string section = register_section<FrostParameters>("frost");
///     scenario.get<FrostParameters>().rate
///
/// A registered section is read from YAML, checked, written, described, given as ROS parameters, listed by
/// dynamic_reconfigure, and changed while a simulation runs.

#include <cstddef>
#include <memory>
#include <string>
#include <typeinfo>
#include <vector>

#include "src/core/parameter_values.hpp"
#include "src/core/validation_errors.hpp"

namespace YAML {
class Node;
class Emitter;
}  // namespace YAML

namespace desert_sim {

struct Scenario;

/// What involves more than one parameter of a section, or others of the scenario.
using SectionCheck = void (*)(const Scenario& scenario, ValidationErrors& errors);

class Section {
 public:
  explicit Section(std::string name) : name_(std::move(name)) {}
  virtual ~Section() = default;
  const std::string& name() const { return name_; }

  virtual std::unique_ptr<Section> clone() const = 0;
  /// Takes the values of a section of the same name and type; references to its parameters stay valid.
  virtual void assign(const Section& other) = 0;
  virtual void visit(const ParameterVisit& visit) = 0;
  virtual void visit(const ConstParameterVisit& visit) const = 0;

  /// Of the list that stands beside the parameters; null where there is none.
  virtual const char* list_name() const { return nullptr; }
  virtual void read_list(const YAML::Node& list, const std::string& key, ValidationErrors& errors);
  virtual void emit_list(YAML::Emitter& out) const;
  virtual void describe_item(std::ostream& out) const;

  void read(const YAML::Node& section, ValidationErrors& errors);
  /// Writes it as an entry of an open map.
  void emit(YAML::Emitter& out) const;
  /// Writes it as markdown.
  void describe(std::ostream& out) const;

 protected:
  Section(const Section&) = default;
  Section& operator=(const Section&) = default;

 private:
  std::string name_;
};

namespace detail {
constexpr std::size_t not_registered = static_cast<std::size_t>(-1);
/// Where the section with parameters of type P stands in Sections.
template <class P>
inline std::size_t section_index = not_registered;
/// Returns the index; of a section that was registered before, whose defaults it replaces, the same.
std::size_t register_section(std::unique_ptr<Section> defaults, SectionCheck check);
[[noreturn]] void throw_not_registered(const char* type);
}  // namespace detail

template <class P>
class SectionOf : public Section {
 public:
  using Section::Section;
  std::unique_ptr<Section> clone() const override { return std::make_unique<SectionOf>(*this); }
  void assign(const Section& other) override { parameters = static_cast<const SectionOf&>(other).parameters; }
  void visit(const ParameterVisit& visit) override { visit_parameters(parameters, visit); }
  void visit(const ConstParameterVisit& visit) const override { visit_parameters(parameters, visit); }
  P parameters;
};

/// Every registered section, with its defaults or what the scenario says.
class Sections {
 public:
  Sections();
  Sections(const Sections& other);
  /// Where both have the same sections, references to their parameters stay valid.
  Sections& operator=(const Sections& other);

  /// Throws Error if no section with these parameters is registered.
  template <class P>
  const P& get() const {
    return static_cast<const SectionOf<P>&>(at<P>()).parameters;
  }
  template <class P>
  P& get() {
    return const_cast<P&>(static_cast<const Sections&>(*this).get<P>());
  }
  template <class P>
  const Section& at() const {
    const std::size_t index = detail::section_index<P>;
    if (index >= sections_.size()) detail::throw_not_registered(typeid(P).name());
    return *sections_[index];
  }
  /// In alphabetical order.
  std::vector<const Section*> all() const;
  std::vector<Section*> all();

 private:
  std::vector<std::unique_ptr<Section>> sections_;  ///< in the order in which they were registered
};

/// Adds an error for each thing that the checks of all registered sections find.
void check_sections(const Scenario& scenario, ValidationErrors& errors);

/// For scenarios that are made from then on; before other threads run. Returns the name. Registering it again
/// replaces it.
template <class P>
std::string register_section(const std::string& name, SectionCheck check = nullptr) {
  static_assert(table_is_complete<P>());
  detail::section_index<P> = detail::register_section(std::make_unique<SectionOf<P>>(name), check);
  return name;
}

}  // namespace desert_sim
