// Messages that are made in the memory of one that nobody needs any more.
#include "src/client/recycled_messages.hpp"

#include <gtest/gtest.h>

#include <thread>
#include <vector>

namespace desert_sim {
namespace {

struct Message {
  std::vector<int> values;
};
using Messages = RecycledMessages<Message>;

TEST(RecycledMessages, TakeTheMemoryOfOneThatNobodyNeeds) {
  const Messages messages;
  boost::shared_ptr<Message> first = messages();
  first->values.assign(1000, 1);
  const Message* const place = first.get();
  const int* const values = first->values.data();
  first.reset();
  const boost::shared_ptr<Message> second = messages();
  EXPECT_EQ(second.get(), place);
  second->values.assign(900, 2);
  EXPECT_EQ(second->values.data(), values);
}

TEST(RecycledMessages, ThatAreNeededKeepTheirMemory) {
  const Messages messages;
  std::vector<boost::shared_ptr<Message>> all{messages(), messages(), messages()};
  EXPECT_NE(all[0], all[1]);
  EXPECT_NE(all[1], all[2]);
  const boost::shared_ptr<const Message> kept = all[0];
  all[0].reset();  // somebody has it still
  EXPECT_NE(messages().get(), kept.get());
}

TEST(RecycledMessages, OutliveWhatMadeThemAndGoBetweenThreads) {
  boost::shared_ptr<Message> last;
  {
    const Messages messages, copy = messages;
    std::vector<std::thread> threads;
    threads.reserve(4);
    for (int n = 0; n < 4; ++n)
      threads.emplace_back([messages, n] {
        for (int k = 0; k < 2000; ++k) {
          const boost::shared_ptr<Message> message = messages();
          message->values.assign(10, n);
          for (int value : message->values) ASSERT_EQ(value, n);
        }
      });
    for (std::thread& thread : threads) thread.join();
    last = copy();
  }
  last->values.assign(10, 1);
  last.reset();
}

}  // namespace
}  // namespace desert_sim
