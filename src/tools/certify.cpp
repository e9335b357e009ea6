#include "src/tools/certify.hpp"

#include <omp.h>
#include <xxhash.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <mutex>
#include <numeric>
#include <thread>

#include "kernels/backend/instruction_set.hpp"
#include "src/core/error.hpp"
#include "src/core/files.hpp"
#include "src/core/hash_text.hpp"
#include "src/core/log.hpp"
#include "src/core/package_folder.hpp"
#include "src/core/quoted.hpp"
#include "src/tools/certified_hash.hpp"
#include "src/tools/progress.hpp"
#include "src/tools/rasters.hpp"

namespace desert_sim {

namespace {

constexpr const char* shipped_certificate = "config/certificate.json";

/// What has become of a run.
struct Outcome {
  std::string not_run;  ///< why; empty: it was to be run
  std::string failure;  ///< empty: it has a hash
  std::uint64_t hash = 0;

  bool has_hash() const { return not_run.empty() && failure.empty(); }
};

/// XXH3 was not final before, and gives other hashes.
void require_final_hash() {
  if (XXH_versionNumber() < 800)
    throw ConfigError(
        "--certify: this system's xxHash is of version " + std::to_string(XXH_versionNumber() / 100 % 100) +
        "." + std::to_string(XXH_versionNumber() % 100) + ", which hashes otherwise than all since 0.8");
}

Certificate certificate_of(const Options& o, const std::string& path) {
  if (!o.has("table") && package_folder().empty())
    throw ConfigError(
        "--certify: the package desert_sim is not in ROS_PACKAGE_PATH (setup.bash of its workspace puts it "
        "there)");
  Certificate runs = read_certificate(path);
  if (o.has("record") && !o.has("table")) add_new_scenarios(runs);
  return runs;
}

/// Numbers of the runs that --only chooses, and of which this build can make.
std::vector<std::size_t> chosen_runs(const Certificate& runs, const Options& o, const std::string& path) {
  const std::string only = o.text("only", "");
  std::vector<std::size_t> chosen;
  for (std::size_t n = 0; n < runs.size(); ++n)
    if (runs[n].name.find(only) != std::string::npos) chosen.push_back(n);
  if (chosen.empty())
    throw ConfigError("--only " + only + ": no run of " + path + " has " + in_quotes(only) + " in its name");
  return chosen;
}

/// Cells and steps of a run; what takes long has to begin early.
std::uint64_t size_of(const CertifiedRun& run) {
  const auto cells = static_cast<std::uint64_t>(run.width) * static_cast<std::uint64_t>(run.height);
  return std::max<std::uint64_t>(cells, 1) * run.steps;
}

/// Makes the runs of these numbers, `jobs` at a time.
void make_runs(const Certificate& runs, std::vector<std::size_t> numbers, const CertifiedPlace& place,
               int jobs, bool quiet, std::vector<Outcome>& outcomes) {
  std::stable_sort(numbers.begin(), numbers.end(),
                   [&](std::size_t a, std::size_t b) { return size_of(runs[a]) > size_of(runs[b]); });
  Progress progress(0, numbers.size(), quiet, "run");
  std::mutex mutex;
  std::atomic<std::size_t> next{0};
  std::uint64_t done = 0;
  const auto work = [&] {
    omp_set_num_threads(place.threads);  // of what runs beside the backend, in this thread
    for (std::size_t n = next++; n < numbers.size(); n = next++) {
      Outcome& outcome = outcomes[numbers[n]];
      try {
        outcome.hash = certified_hash(runs[numbers[n]], place);
      } catch (const std::exception& e) {
        outcome.failure = e.what();
      }
      const std::lock_guard<std::mutex> lock(mutex);
      progress.at(++done);
    }
  };
  std::vector<std::thread> workers;
  workers.reserve(static_cast<std::size_t>(jobs));
  for (int n = 0; n < jobs; ++n) workers.emplace_back(work);
  for (std::thread& worker : workers) worker.join();
}

/// What there is to say about a run; empty if its hash is that of the certificate.
std::string remark(const CertifiedRun& run, const Outcome& outcome, bool recording) {
  if (!outcome.not_run.empty()) return run.name + ": not run, because " + outcome.not_run;
  if (!outcome.failure.empty()) return run.name + ": failed: " + outcome.failure;
  if (recording || run.hash == outcome.hash) return "";
  return run.name + ": expected " + (run.hash ? hash_text(*run.hash) : "no hash, for none is recorded") +
         ", got " + hash_text(outcome.hash);
}

void record(const std::string& path, Certificate runs, const std::vector<Outcome>& outcomes) {
  for (std::size_t n = 0; n < runs.size(); ++n)
    if (outcomes[n].has_hash()) runs[n].hash = outcomes[n].hash;
  write_file(path, certificate_text(runs));
}

}  // namespace

int certify(const Options& o) {
  require_final_hash();
  if (!o.positional().empty())
    throw ConfigError(o.positional()[0] + ": --certify makes the runs of its table (allowed: no SCENARIO)");
  const std::string path = o.text("table", package_folder() + "/" + shipped_certificate);
  const Certificate runs = certificate_of(o, path);
  const std::vector<std::size_t> chosen = chosen_runs(runs, o, path);
  const std::string out = o.text("record", "");
  if (!out.empty()) require_writable_file(out);

  CertifiedPlace place{o.text("backend", "auto"), static_cast<int>(o.number("threads", 1, 1, 4096)),
                       raster_loader()};
  const int processors = omp_get_num_procs();
  const int jobs = static_cast<int>(o.number("jobs", std::max(1, processors / place.threads), 1, 4096));
  const auto exec = make_exec(place.backend, place.threads);
  place.backend = exec->backend();
  const bool on_gpu = exec->device() == Device::cuda;

  std::vector<Outcome> outcomes(runs.size(), Outcome{"it is not chosen", "", 0});
  std::vector<std::size_t> numbers;
  for (const std::size_t n : chosen) {
    outcomes[n].not_run = why_not_run(runs[n]);
    if (outcomes[n].not_run.empty()) numbers.push_back(n);
  }
  // Settings of single runs without an effect, for example, are meant.
  const LogSink former = set_log_sink({});
  set_log_sink([former](Severity severity, const std::string& message) {
    if (severity == Severity::error) former(severity, message);
  });
  const auto begin = std::chrono::steady_clock::now();
  make_runs(runs, numbers, place, jobs, o.has("quiet"), outcomes);
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  set_log_sink(former);

  std::size_t good = 0;
  for (const std::size_t n : chosen) {
    const std::string text = remark(runs[n], outcomes[n], !out.empty());
    if (text.empty()) ++good;
    if (!text.empty()) std::printf("%s\n", text.c_str());
  }
  if (!out.empty()) record(out, runs, outcomes);
  const std::string processor = CpuExec(place.threads).device_name();
  std::printf("%s each, %s%s\n", processor.c_str(), instruction_set_name(instruction_set),
              on_gpu ? ("; " + exec->device_name()).c_str() : "");
  if (numbers.size() < chosen.size())
    std::printf("%zu of %zu runs cannot be made here\n", chosen.size() - numbers.size(), chosen.size());
  std::printf("%zu of %zu hashes are %s %s (%.0f s, %s, %d %s)\n", good, numbers.size(),
              out.empty() ? "those of" : "recorded in", out.empty() ? path.c_str() : out.c_str(), seconds,
              on_gpu ? "GPU" : "CPU", processors, processors == 1 ? "processor" : "processors");
  return good == numbers.size() && !numbers.empty() ? 0 : 1;
}

}  // namespace desert_sim
