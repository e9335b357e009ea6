// Work that is repeated while a word on the device is not 0: by the host, and inside a recording.

#include "kernels/backend/buffer.hpp"
#include "test/support/world.hpp"

namespace desert_sim {
namespace {

/// A queue of words, of which a turn takes the first away.
struct Queue {
  Exec& exec;
  Buffer<long long> words, rest;

  Queue(Exec& on, const std::vector<long long>& content)
      : exec(on), words(on, content.size()), rest(on, content.size()) {
    fill(content);
  }
  void fill(const std::vector<long long>& content) { words.upload(content); }
  void advance() {
    const std::size_t bytes = words.bytes() - sizeof(long long);
    exec.copy(rest.data(), words.data() + 1, bytes);
    exec.copy(words.data(), rest.data(), bytes);
  }
  long long first() const { return words.download().front(); }
  long long second() const { return words.download()[1]; }
};

class Repeat : public test::OnBackend {
 protected:
  /// Replays `work` once it is recorded, where that can be; else does it.
  void recorded(const std::function<void()>& work, const std::function<void()>& before_each, int times) {
    std::unique_ptr<Recording> recording;
    if (exec().can_record_loops()) recording = exec().record(work);
    for (int n = 0; n < times; ++n) {
      before_each();
      recording ? recording->replay() : work();
      exec().synchronise();
    }
  }
};

TEST_P(Repeat, GoesOnUntilTheWordIsZero) {
  Queue queue(exec(), {5, -1, 3, 0, 7, 8});
  exec().repeat_while(queue.words.data(), [&] { queue.advance(); });
  EXPECT_EQ(queue.first(), 0);
  EXPECT_EQ(queue.second(), 7);
}

TEST_P(Repeat, DoesNothingIfTheWordIsZeroFromTheStart) {
  Queue queue(exec(), {0, 1, 2});
  recorded([&] { exec().repeat_while(queue.words.data(), [&] { queue.advance(); }); }, [] {}, 2);
  EXPECT_EQ(queue.second(), 1);
}

TEST_P(Repeat, ARecordingLooksAgainEachTimeItIsReplayed) {
  const std::vector<std::vector<long long>> contents{{1, 1, 0, 9, 0}, {0, 5, 0, 0, 0}, {1, 0, 4, 0, 0}};
  Queue queue(exec(), contents[0]);
  std::vector<long long> seconds;
  std::size_t time = 0;
  recorded([&] { exec().repeat_while(queue.words.data(), [&] { queue.advance(); }); },
           [&] {
             if (time > 0) seconds.push_back(queue.second());
             queue.fill(contents[time++]);
           },
           3);
  seconds.push_back(queue.second());
  EXPECT_EQ(seconds, (std::vector<long long>{9, 5, 4}));
}

/// The outer queue's turn fills the inner one, which empties itself.
TEST_P(Repeat, LoopsMayStandInLoops) {
  Queue outer(exec(), {1, 1, 1, 0, 6}), inner(exec(), {0, 0, 0, 0});
  Buffer<long long> content(exec(), 4);
  content.upload({1, 1, 0, 3});
  recorded(
      [&] {
        exec().repeat_while(outer.words.data(), [&] {
          exec().copy(inner.words.data(), content.data(), content.bytes());
          exec().repeat_while(inner.words.data(), [&] { inner.advance(); });
          outer.advance();
        });
      },
      [&] {
        outer.fill({1, 1, 1, 0, 6});
        inner.fill({0, 0, 0, 0});
      },
      2);
  EXPECT_EQ(outer.first(), 0);
  EXPECT_EQ(outer.second(), 6);
  EXPECT_EQ(inner.second(), 3);
}

DESERT_ON_EACH_BACKEND(Repeat);

}  // namespace
}  // namespace desert_sim
