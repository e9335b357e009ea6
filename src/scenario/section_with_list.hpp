#pragma once
/// A section of parameters that has a list of items beside them, each with a parameter table of its own.

#include "src/core/parameter_page.hpp"
#include "src/scenario/sections.hpp"
#include "src/scenario/yaml_lists.hpp"

namespace desert_sim {

template <class P, class Item>
class SectionWithList final : public SectionOf<P> {
 public:
  SectionWithList(const std::string& name, const char* list_name, std::size_t most)
      : SectionOf<P>(name), list_name_(list_name), most_(most) {}
  std::unique_ptr<Section> clone() const override { return std::make_unique<SectionWithList>(*this); }
  void assign(const Section& other) override {
    SectionOf<P>::assign(other);
    items = static_cast<const SectionWithList&>(other).items;
  }
  const char* list_name() const override { return list_name_; }
  void read_list(const YAML::Node& list, const std::string& key, ValidationErrors& errors) override {
    yaml::read_items(list, key, most_, errors, items);
  }
  void emit_list(YAML::Emitter& out) const override { yaml::emit_items(out, list_name_, items); }
  void describe_item(std::ostream& out) const override { write_parameter_table(out, Item()); }
  std::vector<Item> items;

 private:
  const char* list_name_;
  std::size_t most_;
};

/// As register_section(), with a list of at most `most` items, which list_of<P, Item>() returns.
template <class P, class Item>
std::string register_section(const std::string& name, const char* list_name, std::size_t most) {
  static_assert(table_is_complete<P>() && table_is_complete<Item>());
  detail::section_index<P> =
      detail::register_section(std::make_unique<SectionWithList<P, Item>>(name, list_name, most), nullptr);
  return name;
}

template <class P, class Item>
const std::vector<Item>& list_of(const Sections& sections) {
  return static_cast<const SectionWithList<P, Item>&>(sections.at<P>()).items;
}

}  // namespace desert_sim
