// desert_run --certify: what differs is told, what is not run is named, and the package's table is whole.

#include <xxhash.h>

#include <algorithm>

#include "src/tools/certificate.hpp"
#include "test/support/run_fixture.hpp"
#include "test/support/running.hpp"

namespace desert_sim {
namespace {

const std::string renewal = "; renew the table: desert_run --certify --record config/certificate.json";

std::string shipped_table() { return source_folder() + "/config/certificate.json"; }

TEST(Certificate, HasARunOfEachScenario) {
  const Certificate runs = read_certificate(shipped_table());
  for (const auto& entry : std::filesystem::directory_iterator(source_folder() + "/config/scenarios")) {
    if (entry.path().extension() != ".yaml") continue;
    const std::string name = entry.path().stem();
    EXPECT_TRUE(std::any_of(runs.begin(), runs.end(), [&](const auto& run) { return run.scenario == name; }))
        << "config/certificate.json has no run of the scenario " << name << renewal;
  }
}

TEST(Certificate, HasAHashOfEachRun) {
  for (const CertifiedRun& run : read_certificate(shipped_table()))
    EXPECT_TRUE(run.hash) << "config/certificate.json has no hash of " << run.name << renewal;
}

TEST(Certificate, HasTheFormInWhichItIsWritten) {
  EXPECT_EQ(certificate_text(read_certificate(shipped_table())), test::file_bytes(shipped_table()));
}

TEST(Certificate, HasARunOfEachResult) {
  const Certificate runs = read_certificate(shipped_table());
  for (std::size_t n = 0; n < std::size(certified_results); ++n)
    EXPECT_TRUE(std::any_of(runs.begin(), runs.end(), [n](const auto& run) {
      return static_cast<std::size_t>(run.result) == n;
    })) << certified_results[n];
}

/// In a package of its own, with the scenarios `first` and `second`.
class Certify : public test::DesertRun {
 protected:
  void SetUp() override {
    if (XXH_VERSION_NUMBER < 800) GTEST_SKIP() << "this system's xxHash has other hashes";
    test::DesertRun::SetUp();
    std::filesystem::create_directories(path("package/config/scenarios"));
    folder_.write("package/package.xml", "<package><name>desert_sim</name></package>");
    const std::string rest = ", height: 20}\nterrain: [{noise: {layer: sand, low: 1, high: 2}}]\n";
    folder_.write("package/config/scenarios/first.yaml", "grid: {width: 24" + rest);
    folder_.write("package/config/scenarios/second.yaml", "grid: {width: 300" + rest);
    write({of_first("a"), of_first("b", ", \"settings\": [\"wind.speed=9\"]")});
  }
  /// A run of ten steps without a hash.
  static std::string of_first(const std::string& name, const std::string& more = "") {
    return R"({"name": ")" + name + R"(", "result": "state", "scenario": "first", "size": [16, 16])" + more +
           R"(, "steps": 10, "hash": null})";
  }
  void write(const std::vector<std::string>& runs) {
    std::string text;
    for (const std::string& run : runs) text += (text.empty() ? " " : ",\n ") + run;
    folder_.write("package/config/certificate.json", "{\"runs\": [\n" + text + "\n]}\n");
  }
  std::string table() const { return path("package/config/certificate.json"); }
  test::ProgramRun certify(std::vector<std::string> arguments = {}) {
    arguments.insert(arguments.begin(), {"ROS_PACKAGE_PATH=" + path("package"), program_, "--certify",
                                         "--backend", "cpu", "--quiet"});
    return test::run_program("/usr/bin/env", arguments);
  }
};

void expect_in(const std::string& part, const std::string& text) {
  EXPECT_NE(text.find(part), std::string::npos) << part << " is not in\n" << text;
}

TEST_F(Certify, HashesThatAreRecordedAreFoundAgain) {
  const auto recorded = certify({"--record", table()});
  ASSERT_EQ(recorded.status, 0) << recorded.out << recorded.err;
  expect_in("3 of 3 hashes are recorded in " + table(), recorded.out);
  const std::string text = test::file_bytes(table());
  EXPECT_EQ(certificate_text(read_certificate(table())), text);
  for (const std::vector<std::string>& more :
       {std::vector<std::string>{}, {"--threads", "3"}, {"--jobs", "1"}, {"--table", table()}}) {
    const auto again = certify(more);
    EXPECT_EQ(again.status, 0) << again.out << again.err;
    expect_in("3 of 3 hashes are those of " + table(), again.out);
  }
  EXPECT_EQ(certify({"--record", path("other.json")}).status, 0);
  EXPECT_EQ(test::file_bytes(path("other.json")), text);
}

TEST_F(Certify, ANewScenarioIsAddedWithAtMost256Cells) {
  ASSERT_EQ(certify({"--record", table()}).status, 0);
  const Certificate runs = read_certificate(table());
  ASSERT_EQ(runs.size(), 3U);
  EXPECT_EQ(runs[2].scenario, "second");
  EXPECT_EQ(runs[2].width, 256);
  EXPECT_EQ(runs[2].height, 20);
  EXPECT_EQ(runs[2].steps, 200U);
  EXPECT_TRUE(runs[2].hash);
}

TEST_F(Certify, AnotherHashIsTold) {
  ASSERT_EQ(certify({"--record", table()}).status, 0);
  Certificate runs = read_certificate(table());
  ASSERT_TRUE(runs[0].hash && runs[1].hash);
  EXPECT_NE(*runs[0].hash, *runs[1].hash) << "settings count";
  std::swap(runs[0].hash, runs[1].hash);
  runs[2].hash.reset();
  folder_.write("package/config/certificate.json", certificate_text(runs));
  const auto r = certify();
  EXPECT_EQ(r.status, 1);
  expect_in("a: expected ", r.out);
  expect_in("b: expected ", r.out);
  expect_in("second: expected no hash, for none is recorded, got ", r.out);
  expect_in("0 of 3 hashes are those of ", r.out);
}

TEST_F(Certify, OnlyChoosesAndKeepsTheOthers) {
  const auto r = certify({"--only", "b", "--record", table()});
  EXPECT_EQ(r.status, 0) << r.out << r.err;
  expect_in("1 of 1 hashes are recorded", r.out);
  const Certificate runs = read_certificate(table());
  EXPECT_FALSE(runs[0].hash);
  EXPECT_TRUE(runs[1].hash);
  EXPECT_EQ(certify({"--only", "b"}).status, 0);
  EXPECT_EQ(certify({"--only", "a"}).status, 1);
  const auto unknown = certify({"--only", "nothing_like_it"});
  EXPECT_EQ(unknown.status, 2);
  expect_in("--only nothing_like_it: no run of " + table() + " has 'nothing_like_it' in its name",
            unknown.err);
}

TEST_F(Certify, WhatIsNotInstalledIsNamedAndCountsForNothing) {
  write({of_first("a"),
         R"({"name": "old", "result": "checkpoint", "file": "test/old", "steps": 3, "hash": null})"});
  ASSERT_EQ(certify({"--record", table(), "--table", table(), "--only", "a"}).status, 0);
  const auto r = certify();
  EXPECT_EQ(r.status, 0) << r.out << r.err;
  expect_in("old: not run, because it needs test/old, which is not installed", r.out);
  expect_in("1 of 2 runs cannot be made here", r.out);
  expect_in("1 of 1 hashes are those of ", r.out);
  EXPECT_EQ(certify({"--only", "old"}).status, 1) << "nothing was certified";
}

TEST_F(Certify, RefusesTablesThatAreNone) {
  const auto refused = [&](const std::string& run, const std::string& reason) {
    write({of_first("a"), run});
    const auto r = certify();
    EXPECT_EQ(r.status, 2) << run;
    expect_in(reason, r.err);
  };
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string run = of_first("b");
    return run.replace(run.find(from), from.size(), to);
  };
  refused(of_first("a"), "two runs have the name 'a'");
  refused(with("steps", "stepts"), "run 2 (b): steps: is missing");
  refused(of_first("b", R"(, "sizes": 1)"), "run 2 (b): 'sizes' is not one of: name,");
  refused(with("\"state\"", "\"stat\""), "run 2 (b): result: \"stat\" (allowed: state, halves,");
  refused(with("10", "0"), "run 2 (b): steps: 0 (allowed: 1 ... 1000000000)");
  refused(with("16, 16", "16"), "run 2 (b): size: [16] (allowed: width and height,");
  refused(with("null", "\"12\""), "run 2 (b): hash: \"12\" (allowed: 16 digits");
  refused(with("first", "fist"), "run b: no scenario 'fist' exists");
  refused(with("\"state\"", "\"rover\""), "run 2 (b): rover: is missing");
  refused(with("\"state\"", "\"rover\", \"rover\": \"none\""),
          "config/rovers/none.yaml: no such file exists");
  refused(of_first("b", R"(, "settings": ["wind.speeed=1"])"), "run b: ");
  refused("1", "run 2: is not an object");
  folder_.write("package/config/certificate.json", "{\"runs\": [");
  expect_in("is not JSON", certify().err);
  folder_.write("package/config/certificate.json", "[]");
  expect_in("is no certificate", certify().err);
}

TEST_F(Certify, RefusesWhatItHasNoUseFor) {
  EXPECT_EQ(certify({"first"}).status, 2);
  EXPECT_EQ(certify({"--steps", "3"}).status, 2);
  EXPECT_EQ(run({scenario_, "--only", "a"}).status, 2);
  EXPECT_EQ(certify({"--table", path("none.json")}).status, 2);
  EXPECT_EQ(certify({"--record", path("none/file.json")}).status, 2);
}

}  // namespace
}  // namespace desert_sim
