#include "drivers/robot_selection.h"

#include <gmock/gmock.h>

#include <array>
#include <cstring>

#include "tests/support/allocations.h"

namespace flinch {
namespace {

using testing::SizeIs;

constexpr Time start = 1h;

/// Lets samples of these robots arrive every millisecond; returns how many counted.
int hear(RobotSelection& selection, std::initializer_list<std::uint64_t> robots, Time from, Time to) {
  int counted = 0;
  for (Time now = from; now < to; now += 1ms) {
    for (const std::uint64_t robot : robots) counted += selection.admits(robot, now) ? 1 : 0;
  }
  return counted;
}

void tell_name(RobotSelection& selection, std::uint64_t robot, const char* name) {
  std::array<std::uint8_t, longest_robot_name> letters{};
  std::memcpy(letters.data(), name, std::strlen(name));
  selection.note_name(robot, letters.data());
}

TEST(RobotSelection, TakesTheOnlyRobotOnceItHasLookedForOthers) {
  RobotSelection selection("", 300ms);
  EXPECT_EQ(selection.take(start), 0u);
  EXPECT_EQ(hear(selection, {7}, start, start + 299ms), 299);
  EXPECT_EQ(selection.take(start + 299ms), 0u);
  EXPECT_EQ(selection.take(start + 300ms), 7u);
  EXPECT_EQ(selection.taken(), 7u);
}

TEST(RobotSelection, TakesNoneOfTwoAndLetsNeitherCount) {
  RobotSelection selection("", 300ms);
  EXPECT_EQ(hear(selection, {7}, start, start + 200ms), 200);
  EXPECT_EQ(hear(selection, {8, 7}, start + 200ms, start + 5s), 0);
  EXPECT_TRUE(selection.is_undecided(start + 5s));
  EXPECT_EQ(selection.take(start + 5s), 0u);
  EXPECT_EQ(selection.count(), 2);
}

TEST(RobotSelection, StaysWithTheOneItHasTakenWhoeverAppearsOrLeaves) {
  RobotSelection selection("", 300ms);
  hear(selection, {7}, start, start + 300ms);
  ASSERT_EQ(selection.take(start + 300ms), 7u);
  EXPECT_EQ(hear(selection, {8, 7}, start + 300ms, start + 400ms), 100);
  EXPECT_EQ(hear(selection, {8}, start + 400ms, start + 1min), 0);
  EXPECT_EQ(selection.take(start + 1min), 7u);
  EXPECT_FALSE(selection.is_undecided(start + 1min));
  EXPECT_TRUE(selection.admits(7, start + 1min));
  EXPECT_THAT(selection.robots(), SizeIs(2));
}

TEST(RobotSelection, FindsItsRobotThatWasStartedAgainByItsName) {
  const std::uint64_t first = draw_robot_id("arm"), again = draw_robot_id("arm"),
                      other = draw_robot_id("leg");
  RobotSelection selection("", 300ms);
  hear(selection, {first}, start, start + 300ms);
  ASSERT_EQ(selection.take(start + 300ms), first);
  EXPECT_EQ(hear(selection, {again, other}, start + 400ms, start + 590ms), 0) << "it may only be late";
  EXPECT_GT(hear(selection, {again, other}, start + 590ms, start + 700ms), 90);
  EXPECT_EQ(selection.taken(), again);
  EXPECT_FALSE(selection.admits(first, start + 700ms)) << "it was there before";
}

TEST(RobotSelection, TakesNoneForItsRobotThatWasThereBeforeOrIsNotAloneOrHasNoName) {
  const auto taken_of = [](std::uint64_t first, std::initializer_list<std::uint64_t> before,
                           std::initializer_list<std::uint64_t> after, const std::string& wanted = "") {
    RobotSelection selection(wanted, 300ms);
    hear(selection, {first}, start, start + 300ms);
    EXPECT_EQ(selection.take(start + 300ms), first);
    hear(selection, before, start + 300ms, start + 310ms);
    hear(selection, {first}, start + 310ms, start + 320ms);
    hear(selection, after, start + 400ms, start + 2s);
    return selection.taken();
  };
  const auto arm = [] { return draw_robot_id("arm"); };
  const std::uint64_t first = arm(), second = arm(), third = arm(), nameless = draw_robot_id();
  EXPECT_EQ(taken_of(first, {second}, {second}), first) << "a twin that was there all the time";
  EXPECT_EQ(taken_of(first, {}, {second, third}), first) << "two of them";
  EXPECT_EQ(taken_of(nameless, {}, {draw_robot_id()}), nameless);
  EXPECT_EQ(taken_of(first, {}, {second}, robot_id_text(first)), first) << "this start was chosen";
  EXPECT_EQ(taken_of(first, {}, {second}), second);
}

TEST(RobotSelection, ForgetsARobotThatLeftBeforeAnyWasTaken) {
  RobotSelection selection("", 300ms);
  hear(selection, {7, 8}, start, start + 100ms);
  hear(selection, {8}, start + 100ms, start + 1s);
  EXPECT_EQ(selection.take(start + 1s), 0u);
  EXPECT_GT(hear(selection, {8}, start + 1s, start + 1500ms), 300);
  EXPECT_EQ(selection.take(start + 1500ms), 8u);
}

TEST(RobotSelection, TakesTheChosenOneAmongSeveral) {
  const std::uint64_t left = draw_robot_id("left"), right = draw_robot_id("right");
  for (const std::string& wanted : {std::string("right"), robot_id_text(right)}) {
    RobotSelection selection(wanted, 300ms);
    EXPECT_EQ(hear(selection, {left, right, 7}, start, start + 300ms), 300);
    EXPECT_EQ(selection.take(start + 300ms), right);
  }
}

TEST(RobotSelection, TakesAnIdentityAtOnceForThereIsNoOther) {
  RobotSelection selection(robot_id_text(7), 300ms);
  EXPECT_TRUE(selection.admits(7, start));
  EXPECT_EQ(selection.take(start), 7u);
}

TEST(RobotSelection, TakesNoneOfTwoWithTheChosenName) {
  RobotSelection selection("arm", 300ms);
  EXPECT_EQ(hear(selection, {draw_robot_id("arm"), draw_robot_id("arm")}, start, start + 2s), 1);
  EXPECT_EQ(selection.take(start + 2s), 0u);
}

TEST(RobotSelection, TakesNoneWhereTheChosenOneIsNotThere) {
  RobotSelection selection("arm", 300ms);
  EXPECT_EQ(hear(selection, {7}, start, start + 2s), 0);
  EXPECT_EQ(selection.take(start + 2s), 0u);
  EXPECT_FALSE(selection.is_undecided(start + 2s));
}

TEST(RobotSelection, NeverTakesARobotWithoutAnIdentity) {
  RobotSelection selection("");
  EXPECT_FALSE(selection.admits(0, start));
  EXPECT_EQ(selection.take(start + 1s), 0u);
  EXPECT_EQ(selection.count(), 0);
}

TEST(RobotSelection, KeepsItsRobotWhileStrangersFillItsMemory) {
  RobotSelection selection("", 300ms);
  hear(selection, {7}, start, start + 300ms);
  ASSERT_EQ(selection.take(start + 300ms), 7u);
  Time now = start + 300ms;
  for (std::uint64_t stranger = 100; stranger < 10'000; ++stranger, now += 1ms) {
    EXPECT_FALSE(selection.admits(stranger, now));
  }
  EXPECT_TRUE(selection.admits(7, now));
  EXPECT_EQ(selection.taken(), 7u);
}

TEST(RobotSelection, TellsNamesThatAreNames) {
  RobotSelection selection("");
  hear(selection, {7, 8}, start, start + 10ms);
  tell_name(selection, 7, "left");
  tell_name(selection, 8, "\x1b[2Jclears the screen");
  EXPECT_EQ(text_of(selection.robots()), "left (0000000000000007), 0000000000000008");
}

TEST(RobotSelection, AsksTheHeapForNothingWhereSamplesArriveAndInTheLoop) {
  RobotSelection selection("left");
  const std::int64_t before = test::allocations();
  hear(selection, {draw_robot_id("left"), 8}, start, start + 1s);
  selection.take(start + 1s);
  EXPECT_EQ(selection.count(), 2);
  EXPECT_EQ(test::allocations(), before);
}

}  // namespace
}  // namespace flinch
