#include "src/scenario/yaml_document.hpp"

#include <yaml-cpp/eventhandler.h>

#include <sstream>

namespace desert_sim::yaml {

namespace {

/// Where the last document begins.
struct LastDocument : YAML::EventHandler {
  YAML::Mark begin;

  void OnDocumentStart(const YAML::Mark& mark) override { begin = mark; }
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark&, YAML::anchor_t) override {}
  void OnAlias(const YAML::Mark&, YAML::anchor_t) override {}
  void OnScalar(const YAML::Mark&, const std::string&, YAML::anchor_t, const std::string&) override {}
  void OnSequenceStart(const YAML::Mark&, const std::string&, YAML::anchor_t,
                       YAML::EmitterStyle::value) override {}
  void OnSequenceEnd() override {}
  void OnMapStart(const YAML::Mark&, const std::string&, YAML::anchor_t, YAML::EmitterStyle::value) override {
  }
  void OnMapEnd() override {}
};

}  // namespace

YAML::Node load_document(const std::string& text) {
  std::istringstream stream(text);
  YAML::Parser parser(stream);
  LastDocument last;
  if (parser.HandleNextDocument(last) && parser.HandleNextDocument(last))
    throw YAML::ParserException(
        last.begin, "here begins a second YAML document, or what belongs to none (allowed: one document)");
  return YAML::Load(text);
}

}  // namespace desert_sim::yaml
