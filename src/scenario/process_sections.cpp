#include "src/scenario/process_sections.hpp"

namespace desert_sim {

namespace {

using Sections = std::map<std::string, std::unique_ptr<ProcessSection>>;

Sections& registered() {
  static Sections sections;
  return sections;
}

Sections copy_of(const Sections& sections) {
  Sections copy;
  for (const auto& [name, section] : sections) copy[name] = section->clone();
  return copy;
}

}  // namespace

namespace detail {
void register_section(const std::string& name, std::unique_ptr<ProcessSection> defaults) {
  registered()[name] = std::move(defaults);
}
}  // namespace detail

ProcessSections::ProcessSections() : sections_(copy_of(registered())) {}
ProcessSections::ProcessSections(const ProcessSections& other) : sections_(copy_of(other.sections_)) {}
ProcessSections& ProcessSections::operator=(const ProcessSections& other) {
  sections_ = copy_of(other.sections_);
  return *this;
}

}  // namespace desert_sim
