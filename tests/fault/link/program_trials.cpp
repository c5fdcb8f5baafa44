// Programs and cables that fail.
#include <gtest/gtest.h>

#include "systems/framework/monotonic_clock.h"
#include "tests/fault/link/link_trial.h"
#include "tests/fault/link/trials.h"
#include "tests/support/two_networks.h"

namespace flinch::test {
namespace {

void add(TrialOutcome& outcome, const char* what, const BusLog& log,
         const std::function<std::optional<Latency>(const BusLog&)>& measure) {
  std::optional<Latency> latency;
  if (wait_until(2s, [&] { return (latency = measure(log)).has_value(); })) {
    outcome.findings.push_back({what, *latency});
  } else {
    ADD_FAILURE() << what << ": never";
  }
}

void add_brakes(TrialOutcome& outcome, const LinkTrial& trial, const LogEnd& begin) {
  add(outcome, "robot: brakes closed after the last command", trial.at_robot(),
      [&](const BusLog& log) { return brakes_closed(log, begin); });
}

void add_safe_state(TrialOutcome& outcome, const LinkTrial& trial, const LogEnd& begin, Time last_good) {
  add(outcome, "commander: no torque and brakes after the last reading", trial.at_commander(),
      [&](const BusLog& log) { return safe_command(log, begin, last_good); });
}

void expect_no_motion(const LinkTrial& trial, Time how_long) {
  const std::uint32_t first = trial.at_robot().status.count;
  EXPECT_FALSE(wait_until(how_long, [&] { return opens_brakes(trial.at_robot(), first); }));
  EXPECT_GT(trial.at_robot().status.count, first);
}

/// What stops the commander in mid-motion, and what follows.
TrialOutcome lose_commander(LinkTrial& trial, const std::function<void()>& lose) {
  TrialOutcome outcome;
  trial.get_moving();
  const LogEnd begin(trial.at_robot());
  lose();
  add_brakes(outcome, trial, begin);
  expect_no_motion(trial, 100ms);
  return outcome;
}

TrialOutcome lose_robot(LinkTrial& trial, const std::function<void()>& lose) {
  TrialOutcome outcome;
  trial.get_moving();
  const LogEnd begin(trial.at_commander());
  lose();
  MonotonicClock::sleep_until(MonotonicClock::now() + 5ms);  // what is under way arrives
  add_safe_state(outcome, trial, begin, last_reading_before(trial.at_commander(), MonotonicClock::now()));
  return outcome;
}

}  // namespace

TrialOutcome kill_commander() {
  LinkTrial trial;
  return lose_commander(trial, [&] { trial.commander().kill(); });
}

TrialOutcome hang_commander() {
  LinkTrial trial;
  TrialOutcome outcome = lose_commander(trial, [&] { trial.commander().stop(); });
  trial.commander().resume();
  expect_no_motion(trial, 300ms);
  return outcome;
}

TrialOutcome kill_robot() {
  LinkTrial trial;
  return lose_robot(trial, [&] { trial.robot().kill(); });
}

TrialOutcome hang_robot() {
  LinkTrial trial;
  TrialOutcome outcome = lose_robot(trial, [&] { trial.robot().stop(); });
  const LogEnd hung(trial.at_robot());
  const Time resumed = MonotonicClock::now();
  trial.robot().resume();
  std::optional<std::uint32_t> closed;
  wait_until(1s, [&] {
    const Track<flinch_StatusSample>& status = trial.at_robot().status;
    for (std::uint32_t i = hung.status; i < status.count && !closed; ++i) {
      if (status[i].braked != 0) closed = i;
    }
    return closed.has_value();
  });
  if (!closed) return ADD_FAILURE() << "the robot goes on without brakes", outcome;
  const Time after = Time(trial.at_robot().status[*closed].header.sent_ns) - resumed;
  outcome.findings.push_back({"robot: brakes closed after it went on", {after, 0ms}});
  expect_no_motion(trial, 300ms);
  return outcome;
}

TrialOutcome cut_link() {
  const TwoNetworks networks;
  if (!networks.missing().empty()) return {.findings = {}, .skipped = networks.missing()};
  LinkTrial trial(networks);
  TrialOutcome outcome;
  trial.get_moving();
  const LogEnd robots(trial.at_robot());
  const LogEnd commanders(trial.at_commander());
  networks.cut();
  add_brakes(outcome, trial, robots);
  add_safe_state(outcome, trial, commanders,
                 last_reading_before(trial.at_commander(), MonotonicClock::now()));
  expect_no_motion(trial, 100ms);
  return outcome;
}

}  // namespace flinch::test
