// What becomes of a reaction in the midst of which something fails: random contacts on all four levels, on
// robots that differ from their model. FLINCH_RUNS in the environment says how many of each body and level.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "diagrams/requested_fault.h"
#include "experiments/campaign/campaign.h"
#include "experiments/campaign/campaign_run.h"
#include "plant/obstacle_path.h"
#include "systems/foundation/setup_error.h"
#include "systems/robot/link_segments.h"
#include "systems/robot/workspace_limits.h"
#include "tests/fault/scenario_loop.h"
#include "tests/support/unsure_classifier.h"
#include "tests/support/wanted.h"

namespace flinch {
namespace {

constexpr double at_rest = 0.02;     // [m/s]
constexpr double touched = 1.0;      // [N]
constexpr Time stopped_for = 500ms;  // that is looked at after an alarm
constexpr Time watched = 2s;         // after the failure, where there is none

/// Where the first reaction of a run begins, and how the true robot stands there.
struct Begin {
  Time time{};
  Configuration pose;
  PlatformVector velocity;
  int touched = -1;  ///< BodyId::index()
};

std::optional<Begin> reaction_of(const SimulatedScenario& scenario) {
  test::ScenarioLoop loop(scenario);
  const Context& context = loop.context;
  while (context.time() < scenario.duration) {
    const Time now = context.time();
    loop.tick();
    if (context.get(loop.control.reaction_state).mode != ReactionMode::react) continue;
    const PlatformMotion& truth = context.get(loop.station.platform_truth);
    return Begin{now, truth.pose, truth.velocity, context.get(loop.station.contact_truth).strongest.body};
  }
  return std::nullopt;
}

/// How a run ends in which something failed.
struct Ending {
  bool reacting = false;      ///< the robot gave way to a contact when it failed
  std::optional<Time> alarm;  ///< after the failure, until the gate closes
  GateFault fault = GateFault::none;
  GateReaction reaction = GateReaction::none;  ///< at the end
  ReactionMode mode = ReactionMode::stopped;   ///< at the end
  std::optional<Time> rest;                    ///< after the alarm or, where there is none, after the failure
  bool torque_without_power = false;  ///< the gate handed on a torque once it had given up, or opened a brake
  bool reopened = false;              ///< it let torques of the laws through after it had closed
  bool lost = false, self_contact = false, outside = false;  ///< of the true robot
  bool second_touch = false;                                 ///< by the last of the obstacles
  bool touched = false;                                      ///< by something, at the end
  double largest_torque = 0.0;                               ///< of a drive, that it was told [Nm]
  double late_speed = 0.0;  ///< of the platform, the largest in the last 300 ms [m/s]
  double late_force = 0.0;  ///< of what touches it then, likewise [N]
};

/// Lets the run go on after the failure for as long as it is watched.
Ending ending_of(const SimulatedScenario& scenario, Time failure) {
  test::ScenarioLoop loop(scenario);
  const Context& context = loop.context;
  const ParallelRobot& robot = *scenario.robot.robot;
  const int last_obstacle = static_cast<int>(scenario.station.rig.obstacles.size()) - 1;
  Ending ending;
  Kinematics at;
  bool without_power = false;
  const auto mode = [&] { return context.get(loop.control.reaction_state).mode; };
  const auto end = [&] { return failure + (ending.alarm ? *ending.alarm + stopped_for : watched); };
  while (context.time() < end()) {
    const Time now = context.time();
    loop.tick();
    if (now <= failure) ending.reacting = mode() == ReactionMode::react;
    if (now < failure) continue;
    const GateStatus& gate = context.get(loop.control.gate);
    const ContactTruth& contact = context.get(loop.station.contact_truth);
    const TorqueCommand& torque = context.get(loop.control.torque_command);
    if (gate.phase == GatePhase::closed && !ending.alarm) {
      ending.alarm = now - failure;
      ending.fault = gate.fault;
      ending.rest.reset();
    }
    ending.reopened = ending.reopened || (ending.alarm && gate.phase != GatePhase::closed);
    without_power = without_power || gate.reaction == GateReaction::zero_torque_and_brake;
    if (without_power && (torque.valid || !context.get(loop.control.brake).engage))
      ending.torque_without_power = true;
    if (torque.valid)
      ending.largest_torque = std::max(ending.largest_torque, torque.torque.lpNorm<Eigen::Infinity>());
    ending.reaction = gate.reaction;
    ending.mode = mode();
    ending.touched = contact.in_contact;

    const PlatformMotion& truth = context.get(loop.station.platform_truth);
    robot.kinematics(truth.pose, truth.velocity, at);
    ending.lost = ending.lost || !at.valid;
    ending.outside = ending.outside || !is_within(scenario.control.faults.workspace, robot, at);
    ending.self_contact = ending.self_contact || contact.self_contact;
    if (last_obstacle > 0) {
      for (const TouchTruth* touch : {&contact.strongest, &contact.second, &contact.further[0]})
        ending.second_touch = ending.second_touch || touch->obstacle == last_obstacle;
    }
    const double speed = truth.velocity.head(robot.space().translations()).norm();
    if (now > end() - 300ms) {
      ending.late_speed = std::max(ending.late_speed, speed);
      ending.late_force = std::max(ending.late_force, contact.strongest.strength());
    }
    if (speed >= at_rest) {
      ending.rest.reset();
    } else if (!ending.rest) {
      ending.rest = now - failure - ending.alarm.value_or(0ms);
    }
  }
  return ending;
}

/// What is counted of the endings of a kind.
struct Endings {
  /// `restless`: faster than `at_rest` in the last 300 ms; `thrown`: these, while something touches them.
  std::size_t n = 0, alarms = 0, braked = 0, stopped = 0, restless = 0, thrown = 0, torque = 0, reopened = 0,
              lost = 0, self_contact = 0, outside = 0, second = 0, still_touched = 0;
  double alarm = 0.0, rest = 0.0, rest_without_alarm = 0.0;  ///< the longest [ms]
  double largest_torque = 0.0;                               ///< [Nm]
  double swing = 0.0;  ///< of robots that nothing touches in the last 300 ms, the fastest then [m/s]
  std::map<int, std::size_t> faults, modes;  ///< of the gate; at the end

  void add(const Ending& ending) {
    ++n;
    alarms += ending.alarm ? 1U : 0U;
    braked += ending.reaction == GateReaction::zero_torque_and_brake ? 1U : 0U;
    stopped += ending.reaction == GateReaction::controlled_stop ? 1U : 0U;
    const bool rests = ending.late_speed < at_rest, is_free = ending.late_force < touched;
    restless += rests ? 0U : 1U;
    thrown += rests || is_free ? 0U : 1U;
    if (is_free) swing = std::max(swing, ending.late_speed);
    torque += ending.torque_without_power ? 1U : 0U;
    largest_torque = std::max(largest_torque, ending.largest_torque);
    reopened += ending.reopened ? 1U : 0U;
    lost += ending.lost ? 1U : 0U;
    self_contact += ending.self_contact ? 1U : 0U;
    outside += ending.outside ? 1U : 0U;
    second += ending.second_touch ? 1U : 0U;
    still_touched += ending.touched ? 1U : 0U;
    if (ending.alarm) alarm = std::max(alarm, 1e3 * to_seconds(*ending.alarm));
    double& longest = ending.alarm ? rest : rest_without_alarm;
    if (rests && ending.rest) longest = std::max(longest, 1e3 * to_seconds(*ending.rest));
    ++faults[static_cast<int>(ending.fault)];
    if (rests || is_free) ++modes[static_cast<int>(ending.mode)];
  }

  void print(const std::string& name) const {
    std::printf(
        "%-34s %3zu: %3zu alarms after at most %3.0f ms, at rest %3.0f ms later; others after %3.0f ms; "
        "%zu brakes, %zu stops, %zu do not rest (%zu touched; free ones up to %.3f m/s), %zu touched again, "
        "%zu at the end, %zu outside, %zu lost, "
        "%zu in itself;",
        name.c_str(), n, alarms, alarm, rest, rest_without_alarm, braked, stopped, restless, thrown, swing,
        second, still_touched, outside, lost, self_contact);
    for (const auto& [fault, count] : faults) std::printf(" fault %d: %zu", fault, count);
    for (const auto& [mode, count] : modes) std::printf(" mode %d: %zu", mode, count);
    std::printf("\n");
  }
};

std::string level_of(const CampaignRun& run) {
  return followed_name(run.scenario.control.stages.reaction_laws);
}

/// Makes something fail, in the run and after the begin of its reaction that it is told; says when. None
/// where that cannot be.
using Failure = std::function<std::optional<Time>(SimulatedScenario&, const Begin&, std::mt19937&)>;

/// Endings by level.
std::map<std::string, Endings> fail(const Failure& failure, const std::vector<std::string>& set = {}) {
  CampaignOverrides overrides;
  overrides.draws = test::wanted<std::size_t>("FLINCH_RUNS", 2);
  overrides.set = set;
  const Campaign campaign = read_campaign(
      std::filesystem::path(FLINCH_SOURCE_DIR) / "apps/campaigns/reaction_1000_oracle.yaml", overrides);
  std::map<std::string, Endings> endings;
  for (std::size_t number = 0; number < campaign.runs(); ++number) {
    CampaignRun run = draw_run(campaign, number);
    std::mt19937 random(static_cast<unsigned>(number));
    const std::optional<Begin> begin = reaction_of(run.scenario);
    if (!begin) continue;
    const std::optional<Time> when = failure(run.scenario, *begin, random);
    if (!when) continue;
    const Ending ending = ending_of(run.scenario, *when);
    if (ending.reacting) endings[level_of(run)].add(ending);
  }
  return endings;
}

/// At a tick of the first 100 ms of the reaction.
Time drawn_time(const Begin& begin, std::mt19937& random) {
  return begin.time + std::chrono::milliseconds(1 + random() % 100);
}

/// One of the three drives or legs fails so, at a time that is drawn.
Failure one_of(FaultSignal signal, FaultKind kind, std::optional<double> size) {
  return [=](SimulatedScenario& scenario, const Begin& begin, std::mt19937& random) {
    const Time when = drawn_time(begin, random);
    scenario.station.faults.push_back({.signal = signal,
                                       .index = static_cast<int>(random() % 3),
                                       .kind = kind,
                                       .begin = when,
                                       .size = size});
    return std::optional(when);
  };
}

void print(const std::string& name, const std::map<std::string, Endings>& endings) {
  for (const auto& [level, seen] : endings) seen.print(name + ", " + level.substr(0, level.find('_')));
}

/// What holds whatever fails.
void expect_safe(const std::string& name, const std::map<std::string, Endings>& endings) {
  print(name, endings);
  EXPECT_EQ(endings.size(), 4U) << name;
  for (const auto& [level, seen] : endings) {
    EXPECT_GT(seen.n, 0U) << name << " " << level;
    EXPECT_EQ(seen.torque, 0U) << name << " " << level;
    EXPECT_EQ(seen.reopened, 0U) << name << " " << level;
    EXPECT_EQ(seen.lost, 0U) << name << " " << level;
    EXPECT_EQ(seen.self_contact, 0U) << name << " " << level;
  }
}

/// Where the power goes: at most `alarm` after the failure, and at rest 30 ms later.
void expect_brakes(const std::string& name, const std::map<std::string, Endings>& endings, Time alarm) {
  expect_safe(name, endings);
  for (const auto& [level, seen] : endings) {
    EXPECT_EQ(seen.braked, seen.alarms) << name << " " << level;
    EXPECT_LE(seen.alarm, 1e3 * to_seconds(alarm)) << name << " " << level;
    EXPECT_LE(seen.rest, 30.0) << name << " " << level;
    EXPECT_EQ(seen.restless, 0U) << name << " " << level;
  }
}

void expect_always_an_alarm(const std::map<std::string, Endings>& endings) {
  for (const auto& [level, seen] : endings) EXPECT_EQ(seen.alarms, seen.n) << level;
}

/// Where the reaction goes on: the gate stays open, and the robot ends where it is allowed to be, at rest by
/// then. Constraints that are tasks may move a free robot a little in hold, docs/theory.md.
void expect_open(const std::string& name, const std::map<std::string, Endings>& endings, Time rest) {
  expect_safe(name, endings);
  for (const auto& [level, seen] : endings) {
    EXPECT_EQ(seen.alarms, 0U) << name << " " << level;
    EXPECT_EQ(seen.outside, 0U) << name << " " << level;
    EXPECT_LE(seen.rest_without_alarm, 1e3 * to_seconds(rest)) << name << " " << level;
    EXPECT_LT(seen.swing, level == "strict_reaction" ? at_rest : 0.1) << name << " " << level;
    for (const auto& [mode, count] : seen.modes)
      EXPECT_TRUE(mode == static_cast<int>(ReactionMode::hold) ||
                  mode == static_cast<int>(ReactionMode::zero_g))
          << name << " " << level << ": " << count << " in mode " << mode;
  }
}

TEST(AReaction, ThatLosesThePoseEndsInTheBrakes) {
  const Failure all_encoders = [](SimulatedScenario& scenario, const Begin& begin, std::mt19937& random) {
    const Time when = drawn_time(begin, random);
    scenario.station.faults.push_back(
        {.signal = FaultSignal::encoder, .kind = FaultKind::off, .begin = when});
    return std::optional(when);
  };
  using enum FaultSignal;
  using enum FaultKind;
  const auto expect = [](const std::string& name, const Failure& failure, Time alarm) {
    const std::map<std::string, Endings> endings = fail(failure);
    expect_brakes(name, endings, alarm);
    expect_always_an_alarm(endings);
  };
  expect("encoders off", all_encoders, 2ms);
  expect("encoder wrong by 0.2 rad", one_of(encoder, wrong, 0.2), 0ms);
  expect("passive encoder wrong by 0.1 rad", one_of(passive_encoder, wrong, 0.1), 0ms);
  expect("encoder stuck", one_of(encoder, stuck, std::nullopt), 20ms);
}

// It is detected where it is asked for more. A reaction that never asks for as much goes on to its end.
TEST(AReaction, WhoseDriveGivesLessThanItIsToldEndsInTheBrakes) {
  for (const double limit : {5.0, 20.0}) {
    const Failure saturated = [limit](SimulatedScenario& scenario, const Begin& begin, std::mt19937& random) {
      const Time when = begin.time + 1ms;
      scenario.station.faults.push_back({.signal = FaultSignal::drive,
                                         .index = static_cast<int>(random() % 3),
                                         .kind = FaultKind::saturated,
                                         .begin = when,
                                         .size = limit});
      return std::optional(when);
    };
    expect_brakes("drive of " + std::to_string(static_cast<int>(limit)) + " Nm", fail(saturated), 500ms);
  }
}

/// The begin of the reaction once the control path has been changed so.
Failure changed(const std::function<void(SimulatedScenario&)>& change) {
  return [change](SimulatedScenario& scenario, const Begin&, std::mt19937&) -> std::optional<Time> {
    change(scenario);
    const std::optional<Begin> begin = reaction_of(scenario);
    return begin ? std::optional(begin->time) : std::nullopt;
  };
}

// What the robot plans and keeps limits by is what its drives can do, which the reaction takes whole.
TEST(AReaction, OfWeakDrivesEndsAtRestWithinTheWorkspace) {
  constexpr double most = 40.0;  // [Nm]
  const std::map<std::string, Endings> endings = fail(changed([most](SimulatedScenario& scenario) {
    ContactControlSettings& control = scenario.control;
    control.torque_gate.max_torque = control.limits.max_torque = most;
    control.tasks.levels.largest_torque = control.tasks.reaction.max_torque = most;
    control.faults.torque_range = most;
    scenario.station.drives.max_torque.setConstant(most);
  }));
  expect_open("drives of 40 Nm", endings, 600ms);
  for (const auto& [level, seen] : endings) {
    EXPECT_NEAR(seen.largest_torque, most, 1e-9) << level;
    EXPECT_EQ(seen.restless, 0U) << level;
  }
}

TEST(AReaction, ToWhatNobodyCanTellEndsAtRestWithinTheWorkspace) {
  const std::map<std::string, Endings> endings =
      fail(changed([](SimulatedScenario& scenario) {
             ControlStages& stages = scenario.control.stages;
             stages.classifiers = {};
             stages.classifiers.follow(test::unsure_classifier(0.9));
           }),
           {"plant.classification=controller"});
  expect_open("class rejected", endings, 500ms);
  for (const auto& [level, seen] : endings) EXPECT_EQ(seen.restless, 0U) << level;
}

/// Something that comes to a first link of a leg that is not touched, from one side, and goes away again.
std::shared_ptr<const Obstacle> intruder(const ParallelRobot& robot, const Begin& begin,
                                         std::mt19937& random) {
  constexpr double radius = 0.02, away = 0.12, deep = 0.02;  // [m]
  const int leg = begin.touched <= 2 ? 1 : 0;
  Kinematics at;
  robot.kinematics(begin.pose, begin.velocity, at);
  const Segment link = link_segment(at, BodyId::link1(leg));
  const Eigen::Vector2d along = (link.end - link.begin).normalized();
  const Eigen::Vector2d side = (random() % 2 == 0 ? 1.0 : -1.0) * Eigen::Vector2d(-along.y(), along.x());
  const Eigen::Vector2d place = link.begin + 0.7 * (link.end - link.begin) + away * side;
  const auto time = [&](double after) { return to_seconds(begin.time) + after; };
  const Eigen::Vector2d way = -(away - radius + deep) * side;
  const ObstaclePath path({{time(-0.1), Eigen::Vector3d::Zero()},
                           {time(0.08), Eigen::Vector3d(way.x(), way.y(), 0.0)},
                           {time(0.18), Eigen::Vector3d(way.x(), way.y(), 0.0)},
                           {time(0.4), Eigen::Vector3d::Zero()}});
  ObstacleForm form;
  form.name = "intruder";
  form.shape = Sphere{.centre = {0.0, 0.0, 0.0}, .radius = radius};
  form.position_in_base = {place.x(), place.y(), 0.0};
  return std::make_shared<const MovingObstacle>(form, path);
}

TEST(AReaction, InTheMidstOfWhichAnotherBodyIsTouchedEndsAtRestWithinTheWorkspace) {
  const Failure second = [](SimulatedScenario& scenario, const Begin& begin,
                            std::mt19937& random) -> std::optional<Time> {
    scenario.station.rig.obstacles.push_back(intruder(*scenario.robot.robot, begin, random));
    try {
      const std::optional<Begin> now = reaction_of(scenario);
      if (!now || now->time != begin.time) return std::nullopt;  // it touched before
    } catch (const SetupError&) {                                // it stands in the way from the start
      return std::nullopt;
    }
    return begin.time;
  };
  const std::map<std::string, Endings> by_default =
      fail(second, {"control.sequence.zero_g_when_struck=true"});
  expect_open("another body", by_default, 1s);
  for (const auto& [level, seen] : by_default) {
    EXPECT_EQ(seen.second, seen.n) << level;
    EXPECT_EQ(seen.restless, 0U) << level;
  }
  // Who gives way to hard contacts too is not thrown from one thing to the other, docs/theory.md.
  const std::map<std::string, Endings> giving_way = fail(second);
  expect_open("another body, giving way", giving_way, 1s);
  for (const auto& [level, seen] : giving_way) {
    EXPECT_EQ(seen.second, seen.n) << level;
    EXPECT_EQ(seen.thrown, 0U) << level;
  }
}

}  // namespace
}  // namespace flinch
