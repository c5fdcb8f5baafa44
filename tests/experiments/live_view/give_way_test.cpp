#include "experiments/live_view/give_way.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <thread>

namespace flinch {
namespace {

int niceness_of_this_thread() { return getpriority(PRIO_PROCESS, static_cast<id_t>(gettid())); }

TEST(GiveWay, ChangesThisThreadAndThoseThatItStarts) {
  const int before = niceness_of_this_thread();
  int own = 0, of_next = 0;
  std::thread([&] {
    give_way();
    own = niceness_of_this_thread();
    std::thread([&] { of_next = niceness_of_this_thread(); }).join();
  }).join();
  EXPECT_EQ(own, 10);
  EXPECT_EQ(of_next, 10);
  EXPECT_EQ(niceness_of_this_thread(), before);
}

}  // namespace
}  // namespace flinch
