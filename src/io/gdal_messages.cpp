#include "src/io/gdal_messages.hpp"

#include <gdal_priv.h>

#include <algorithm>
#include <mutex>

namespace desert_sim {

namespace {
void on_gdal_message(CPLErr level, CPLErrorNum, const char* message) {
  auto* messages = static_cast<GdalMessages*>(CPLGetErrorHandlerUserData());
  if (messages && level >= CE_Warning) messages->add(level >= CE_Failure, message);
}
}  // namespace

GdalMessages::GdalMessages() {
  CPLPushErrorHandlerEx(on_gdal_message, this);
  static std::once_flag once;
  std::call_once(once, [] { GDALAllRegister(); });
  clear();
}

GdalMessages::~GdalMessages() { CPLPopErrorHandler(); }

void GdalMessages::clear() {
  failures_ = 0;
  failure_texts_.clear();
  warning_texts_.clear();
}

void GdalMessages::add(bool failure, const char* message) {
  constexpr std::size_t max_texts = 3;
  failures_ += failure;
  auto& texts = failure ? failure_texts_ : warning_texts_;
  std::string line = message ? message : "";
  std::replace(line.begin(), line.end(), '\n', ' ');
  if (texts.size() < max_texts && std::find(texts.begin(), texts.end(), line) == texts.end())
    texts.push_back(line);
}

std::string GdalMessages::text() const {
  const auto& texts = failure_texts_.empty() ? warning_texts_ : failure_texts_;
  if (texts.empty()) return "no reason given";
  std::string joined = texts.front();
  for (std::size_t i = 1; i < texts.size(); ++i) joined += "; " + texts[i];
  return joined;
}

}  // namespace desert_sim
