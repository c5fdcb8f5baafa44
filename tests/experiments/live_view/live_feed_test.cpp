#include "experiments/live_view/live_feed.h"

#include <gtest/gtest.h>

#include <thread>

namespace flinch {
namespace {

using std::chrono::milliseconds;

TEST(LiveFeed, GivesMessagesInOrder) {
  LiveFeed feed(10, 1000);
  EXPECT_FALSE(feed.after(0, milliseconds(0)));
  feed.publish("a");
  feed.publish("b");
  EXPECT_EQ(*feed.after(0, milliseconds(0))->text, "a");
  EXPECT_EQ(*feed.after(1, milliseconds(0))->text, "b");
  EXPECT_FALSE(feed.after(2, milliseconds(0)));
}

TEST(LiveFeed, SkipsWhatIsNoLongerKept) {
  LiveFeed feed(3, 1000);
  for (const char* text : {"1", "2", "3", "4", "5"}) feed.publish(text);
  const auto next = feed.after(1, milliseconds(0));
  EXPECT_EQ(next->number, 3U);
  EXPECT_EQ(*next->text, "3");
}

TEST(LiveFeed, KeepsNoMoreBytesThanItMayButAlwaysTheLast) {
  LiveFeed feed(100, 10);
  feed.publish("123456");
  feed.publish("789012");
  EXPECT_EQ(feed.after(0, milliseconds(0))->number, 2U);
  feed.publish(std::string(50, 'x'));
  EXPECT_EQ(feed.after(0, milliseconds(0))->number, 3U);
}

TEST(LiveFeed, WakesWhoWaits) {
  LiveFeed feed(10, 1000);
  std::thread later([&feed] {
    std::this_thread::sleep_for(milliseconds(20));
    feed.publish("x");
    feed.close();
  });
  EXPECT_TRUE(feed.after(0, milliseconds(20'000)));
  EXPECT_FALSE(feed.after(1, milliseconds(20'000))) << "closed";
  EXPECT_TRUE(feed.is_closed());
  later.join();
}

}  // namespace
}  // namespace flinch
