// A bad network, a bad clock.
#include <gtest/gtest.h>

#include "systems/framework/monotonic_clock.h"
#include "tests/fault/link/link_course.h"
#include "tests/fault/link/link_trial.h"
#include "tests/fault/link/trials.h"

namespace flinch::test {
namespace {

/// What has been refused of the commands, by the last status.
std::uint32_t refused(const BusLog& log) { return log.status[log.status.count - 1].commands_refused; }

/// How the robot goes on through `trouble`.
Course course_through(const LinkTrial& trial, Time how_long, const std::function<void()>& trouble) {
  const LogEnd begin(trial.at_robot());
  const std::uint32_t session = present_commander(trial.at_robot());
  trouble();
  MonotonicClock::sleep_until(MonotonicClock::now() + how_long);
  return course(trial.at_robot(), begin, session);
}

}  // namespace

TrialOutcome lose_samples() {
  LinkTrial trial;
  TrialOutcome outcome;
  trial.get_moving();
  const LogEnd begin(trial.at_robot());
  trial.trouble()->lost_per_mille = 300;
  std::optional<Latency> brakes;
  EXPECT_TRUE(wait_until(3s, [&] { return (brakes = brakes_closed(trial.at_robot(), begin)).has_value(); }));
  const std::uint64_t lost = trial.trouble()->lost;
  trial.trouble()->lost_per_mille = 0;
  EXPECT_GT(lost, 0u);
  if (brakes) outcome.findings.push_back({"robot: brakes closed after the last command", *brakes});
  return outcome;
}

TrialOutcome delay_samples() {
  LinkTrial trial;
  TrialOutcome outcome;
  trial.get_moving();
  const LogEnd begin(trial.at_robot());
  const std::uint32_t refused_before = refused(trial.at_robot());
  const Time from = MonotonicClock::now() + 20ms;
  const Time until = from + 20ms;
  trial.trouble()->held_until = until.count();
  trial.trouble()->held_from = from.count();
  MonotonicClock::sleep_until(until + 100ms);
  EXPECT_GT(trial.trouble()->held, 0u);
  EXPECT_GT(refused(trial.at_robot()), refused_before);

  if (const auto brakes = brakes_closed(trial.at_robot(), begin)) {
    outcome.findings.push_back({"robot: brakes closed after the last command", *brakes});
  } else {
    ADD_FAILURE() << "the brakes stay open";
  }
  if (const auto safe =
          safe_command(trial.at_commander(), begin, last_reading_before(trial.at_commander(), from))) {
    outcome.findings.push_back({"commander: no torque and brakes after the last reading", *safe});
  } else {
    ADD_FAILURE() << "the commander goes on";
  }
  return outcome;
}

TrialOutcome duplicate_and_reorder_samples() {
  expect_undisturbed([] {
    LinkTrial trial;
    trial.get_moving();
    const Course went = course_through(trial, 500ms, [&] {
      trial.trouble()->duplicated_per_mille = 300;
      trial.trouble()->overtaken_per_mille = 100;
    });
    EXPECT_GT(trial.trouble()->duplicated, 300u);
    EXPECT_GT(trial.trouble()->overtaken, 20u);
    return went;
  });
  return {};
}

TrialOutcome step_clock() {
  constexpr std::int64_t hour = 3'600'000'000'000;
  for (const std::int64_t step : {hour, -hour}) {
    expect_undisturbed([step] {
      LinkTrial trial;
      trial.get_moving();
      const Course went = course_through(trial, 500ms, [&] { trial.trouble()->wall_clock_step = step; });
      EXPECT_GT(trial.trouble()->wrong_wall_times, 100u);
      return went;
    });
  }
  return {};
}

}  // namespace flinch::test
