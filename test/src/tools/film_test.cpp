// desert_run --film: pictures and films without a screen.

#include <csignal>
#include <filesystem>
#include <fstream>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

#include "test/support/run_fixture.hpp"

namespace desert_sim {
namespace {

namespace fs = std::filesystem;

class Film : public test::DesertRun {
 protected:
  static cv::Mat read(const std::string& file) { return cv::imread(file, cv::IMREAD_COLOR); }
  /// The share of pixels in which two pictures differ clearly.
  static double difference(const cv::Mat& a, const cv::Mat& b) {
    cv::Mat apart;
    cv::absdiff(a, b, apart);
    return static_cast<double>(cv::countNonZero(apart.reshape(1) > 12)) / static_cast<double>(3 * a.total());
  }
};

TEST_F(Film, IsAFolderOfPicturesOfTheAskedSize) {
  run_cpu({scenario_, "--steps", "6", "--film", path("frames/deep"), "--film-every", "2", "--view",
           "width=200", "--view", "height=120"});
  std::size_t files = 0;
  for (const auto& entry : fs::directory_iterator(path("frames/deep")))
    files += entry.is_regular_file() ? 1 : 0;
  EXPECT_EQ(files, 4u) << "at the steps 0, 2, 4 and 6";
  const cv::Mat first = read(path("frames/deep/frame_000000.png")),
                last = read(path("frames/deep/frame_000003.png"));
  ASSERT_EQ(first.cols, 200);
  ASSERT_EQ(first.rows, 120);
  EXPECT_GT(difference(first, last), 1e-4) << "the sand has moved";
}

TEST_F(Film, OfAPngIsThePictureOfTheEnd) {
  const auto film = [this](const std::string& name, const std::vector<std::string>& more) {
    std::vector<std::string> words{scenario_, "--steps",   "4",      "--film",    path(name),
                                   "--view",  "width=160", "--view", "height=100"};
    words.insert(words.end(), more.begin(), more.end());
    run_cpu(words);
  };
  film("end.png", {});
  film("all", {"--film-every", "1"});
  const cv::Mat end = read(path("end.png"));
  EXPECT_EQ(difference(end, read(path("all/frame_000004.png"))), 0);
  EXPECT_GT(difference(end, read(path("all/frame_000000.png"))), 0);
}

TEST_F(Film, IsTheSameForTheSameRunAndAnotherFromElsewhere) {
  const auto picture = [&](const std::string& name, const std::vector<std::string>& more) {
    std::vector<std::string> words{scenario_, "--steps",   "3",      "--film",    path(name),
                                   "--view",  "width=160", "--view", "height=100"};
    words.insert(words.end(), more.begin(), more.end());
    run_cpu(words);
    return read(path(name));
  };
  const cv::Mat usual = picture("a.png", {});
  EXPECT_EQ(difference(usual, picture("b.png", {"--threads", "2"})), 0);
  EXPECT_GT(difference(usual, picture("c.png", {"--view", "azimuth_deg=100"})), 0.05);
  EXPECT_GT(difference(usual, picture("d.png", {"--view", "overlay=sand_depth"})), 0.05);
  EXPECT_GT(difference(usual, picture("e.png", {"--view", "contour_interval=0.2"})), 1e-3);
}

TEST_F(Film, OfAnMp4HasOnePictureForEach) {
  run_cpu({scenario_, "--steps", "10", "--film", path("run.mp4"), "--film-every", "1", "--view", "width=160",
           "--view", "height=90"});
  ASSERT_GT(fs::file_size(path("run.mp4")), 500u);
  const test::ProgramRun probe = test::run_program(
      "/usr/bin/ffprobe", {"-v", "error", "-count_frames", "-show_entries",
                           "stream=nb_read_frames,width,height", "-of", "csv=p=0", path("run.mp4")});
  EXPECT_EQ(probe.out, "160,90,11\n") << probe.err;
}

TEST_F(Film, RefusesWhatCannotBeMade) {
  const auto refused = [&](const std::vector<std::string>& words, const std::string& what) {
    std::vector<std::string> all{scenario_, "--steps", "1"};
    all.insert(all.end(), words.begin(), words.end());
    const test::ProgramRun r = run(all);
    EXPECT_EQ(r.status, 2) << r.err;
    EXPECT_NE(r.err.find(what), std::string::npos) << r.err;
  };
  refused({"--film", path("a.mp4"), "--view", "width=161"}, "even numbers");
  refused({"--film", path("a.png"), "--view", "widht=160"}, "unknown key");
  refused({"--film", path("a.png"), "--view", "width=5"}, "is not in [16, 7680]");
  refused({"--film", path("a.png"), "--view", "overlay=gold"}, "is not one of: elevation");
  refused({"--view", "width=160"}, "--view requires --film");
  refused({"--film", path("a.png"), "--film-every", "2"}, "a.png is one picture, of the end");
  refused({"--film", path("no/such/a.png")}, "cannot be written");
  refused({"--film", path("a.gif")}, ".gif is not made here (allowed: .mp4, .png, or a folder");
  refused({"--film", path("a.MP4")}, "write the extension as .mp4");
  EXPECT_FALSE(fs::exists(path("a.mp4")));
  EXPECT_FALSE(fs::exists(path("a.png")));
  EXPECT_FALSE(fs::exists(path("a.gif")));
}

/// ffmpeg itself ends with 0 there.
TEST_F(Film, OnAFullDiskIsAFailure) {
  std::ofstream(path("run.mp4")) << "an older film";
  const test::ProgramRun r = test::run_program(
      "/bin/sh", {"-c", "trap '' XFSZ; ulimit -f 8; exec \"$0\" \"$@\"", program_, scenario_, "--backend",
                  "cpu", "--quiet", "--steps", "40", "--film-every", "1", "--view", "width=320", "--view",
                  "height=240", "--film", path("run.mp4")});
  EXPECT_EQ(r.status, 3) << r.err;
  EXPECT_NE(r.err.find("ffmpeg"), std::string::npos) << r.err;
  EXPECT_NE(r.err.find("File too large"), std::string::npos) << r.err;
  EXPECT_EQ(test::file_bytes(path("run.mp4")), "an older film");
}

/// Ctrl-C goes to all processes of the terminal's group: the encoder is not among them.
TEST_F(Film, IsFinishedAfterCtrlC) {
  const test::ProgramRun r =
      run({scenario_, "--backend", "cpu", "--steps", "100000000", "--film-every", "1", "--view", "width=160",
           "--view", "height=90", "--film", path("run.mp4")},
          {{SIGINT, [](const std::string& err) { return err.find("step ") != std::string::npos; }}});
  EXPECT_EQ(r.status, 130) << r.err;
  const test::ProgramRun probe =
      test::run_program("/usr/bin/ffprobe",
                        {"-v", "error", "-show_entries", "stream=width", "-of", "csv=p=0", path("run.mp4")});
  EXPECT_EQ(probe.out, "160\n") << probe.err;
}

}  // namespace
}  // namespace desert_sim
