#include "src/scenario/sections.hpp"

#include <yaml-cpp/yaml.h>

#include <algorithm>

#include "src/core/error.hpp"
#include "src/core/parameter_page.hpp"
#include "src/scenario/scenario.hpp"
#include "src/scenario/yaml_parameters.hpp"

namespace desert_sim {

namespace {

struct Registered {
  std::unique_ptr<Section> defaults;
  SectionCheck check;
};

std::vector<Registered>& registered() {
  static std::vector<Registered> sections;
  return sections;
}

/// Of the section with this name; the number of sections if there is none.
std::size_t index_of(const std::string& name) {
  const std::vector<Registered>& all = registered();
  const auto found = std::find_if(all.begin(), all.end(),
                                  [&](const Registered& one) { return one.defaults->name() == name; });
  return static_cast<std::size_t>(found - all.begin());
}

template <class S, class All>
std::vector<S*> in_alphabetical_order(All& sections) {
  std::vector<S*> all;
  all.reserve(sections.size());
  for (auto& section : sections) all.push_back(section.get());
  std::sort(all.begin(), all.end(), [](const Section* a, const Section* b) { return a->name() < b->name(); });
  return all;
}

}  // namespace

namespace detail {

std::size_t register_section(std::unique_ptr<Section> defaults, SectionCheck check) {
  std::vector<Registered>& all = registered();
  const std::size_t index = index_of(defaults->name());
  if (index == all.size()) all.emplace_back();
  all[index] = {std::move(defaults), check};
  return index;
}

void throw_not_registered(const char* type) {
  throw Error(std::string("no section of a scenario is registered for the parameters ") + type);
}

}  // namespace detail

void Section::read_list(const YAML::Node&, const std::string&, ValidationErrors&) {}
void Section::emit_list(YAML::Emitter&) const {}
void Section::describe_item(std::ostream&) const {}

void Section::read(const YAML::Node& section, ValidationErrors& errors) {
  std::set<std::string> known;
  visit([&](const ParameterRow& row, ParameterValue value) {
    known.insert(row.name);
    yaml::read_entry(section, row, name_ + ".", errors, value);
  });
  if (list_name()) known.insert(list_name());
  yaml::reject_unknown_keys(section, name_ + ".", known, errors);
  if (list_name() && section.IsDefined() && section.IsMap())
    read_list(section[list_name()], name_ + "." + list_name(), errors);
}

void Section::emit(YAML::Emitter& out) const {
  out << YAML::Key << name_ << YAML::Value << YAML::BeginMap;
  visit([&](const ParameterRow& row, ConstParameterValue value) { yaml::emit_entry(out, row, value); });
  emit_list(out);
  out << YAML::EndMap;
}

void Section::describe(std::ostream& out) const {
  out << "\n## `" << name_ << "`\n\n";
  write_parameter_table_head(out);
  visit([&](const ParameterRow& row, ConstParameterValue value) { write_parameter_row(out, row, value); });
  if (!list_name()) return;
  out << "\n### each of `" << name_ << "." << list_name() << "`\n\n";
  describe_item(out);
}

Sections::Sections() {
  for (const Registered& one : registered()) sections_.push_back(one.defaults->clone());
}

Sections::Sections(const Sections& other) {
  for (const auto& section : other.sections_) sections_.push_back(section->clone());
}

Sections& Sections::operator=(const Sections& other) {
  if (this == &other) return *this;
  const bool alike =
      std::equal(sections_.begin(), sections_.end(), other.sections_.begin(), other.sections_.end(),
                 [](const auto& a, const auto& b) { return typeid(*a) == typeid(*b); });
  if (!alike) {
    sections_ = Sections(other).sections_;  // one has a section that was registered after the other was made
    return *this;
  }
  for (std::size_t n = 0; n < sections_.size(); ++n) sections_[n]->assign(*other.sections_[n]);
  return *this;
}

std::vector<const Section*> Sections::all() const { return in_alphabetical_order<const Section>(sections_); }
std::vector<Section*> Sections::all() { return in_alphabetical_order<Section>(sections_); }

void check_sections(const Scenario& scenario, ValidationErrors& errors) {
  for (const Section* section : scenario.sections.all()) {
    const SectionCheck check = registered()[index_of(section->name())].check;
    if (check) check(scenario, errors);
  }
}

}  // namespace desert_sim
