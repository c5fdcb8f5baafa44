#include "tests/fault/link/link_course.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <iostream>

#include "tests/fault/link/link_trial.h"

namespace flinch::test {

std::uint32_t present_commander(const BusLog& log) {
  const std::uint32_t count = log.status.count;
  return count > 0 ? log.status[count - 1].commander : 0;
}

std::uint64_t present_robot(const BusLog& log) {
  const std::uint32_t count = log.status.count;
  return count > 0 ? log.status[count - 1].header.robot_id : 0;
}

Course course(const BusLog& log, const LogEnd& begin, std::uint32_t session) {
  Course sum;
  const std::uint32_t end = log.status.count;
  for (std::uint32_t i = std::max(begin.status, 1u); i < end; ++i) {
    const flinch_StatusSample& now = log.status[i];
    const flinch_StatusSample& before = log.status[i - 1];
    ++sum.ticks;
    sum.braked += now.braked;
    sum.silent += now.commander == 0 ? 1 : 0;
    sum.by_others += now.commander != 0 && now.commander != session ? 1 : 0;
    sum.backwards += now.commander == before.commander && now.header.number > before.header.number &&
                             now.command_number < before.command_number
                         ? 1
                         : 0;
  }
  if (sum.ticks > 0)
    sum.refused = log.status[end - 1].commands_refused - log.status[begin.status].commands_refused;
  sum.lateness = std::max(lateness(log.status, begin.status, end),
                          lateness(log.commands, begin.commands, log.commands.count, session));
  return sum;
}

void expect_undisturbed(const std::function<Course()>& trial) {
  for (int attempt = 0; attempt < 3; ++attempt) {
    const Course went = trial();
    EXPECT_EQ(went.by_others, 0u);
    if (went.is_undisturbed() || went.lateness < 1ms) {
      EXPECT_GT(went.ticks, 100u);
      EXPECT_EQ(went.braked, 0u) << "of " << went.ticks << " ticks";
      EXPECT_EQ(went.silent, 0u) << "of " << went.ticks << " ticks";
      EXPECT_EQ(went.backwards, 0u);
      return;
    }
    std::cout << "the machine was late by " << 1e3 * to_seconds(went.lateness) << " ms" << std::endl;
  }
  throw TooBusy("the machine was late each time");
}

}  // namespace flinch::test
