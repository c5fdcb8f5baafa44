// What the robot does by default about contacts of every sort: it stays within its workspace, comes to rest,
// and can be pushed by hand after a hard one. Half of the robots differ from their model. FLINCH_RUNS in the
// environment says how many runs of each body; 200 are all of the file, docs/theory.md has 250.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "experiments/campaign/campaign.h"
#include "experiments/campaign/campaign_run.h"
#include "experiments/campaign/exact_bounds.h"
#include "systems/robot/workspace_limits.h"
#include "tests/campaign/limits/reactions_within_limits.h"
#include "tests/fault/scenario_loop.h"
#include "tests/support/in_parallel.h"
#include "tests/support/wanted.h"

namespace flinch {
namespace {

using test::at_rest;

constexpr Time rest_asked = 500ms;  // after the hard contact
constexpr Time watched = 600ms;     // after it
constexpr Time pushed = 500ms;      // by hand, after that
constexpr double hand = 15.0;       // [N]
constexpr double hand_speed = 0.1;  // [m/s]
constexpr double never = 9.0;       // [s]
constexpr double touched = 1.0;     // [N]

/// What the true robot did.
struct Answer {
  std::size_t number = 0;
  std::string body;
  bool detected = false, struck = false;
  bool fault = false, lost = false, outside = false;
  double det_A = 1.0, distance = 0.0, rotation = 0.0;
  double peak_force = 0.0;     ///< [N]
  std::optional<double> rest;  ///< after the hard contact, until it stays slow [s]
  double slow_force = 0.0;     ///< on it while it was still faster, after the time asked [N]
  double led_speed = 0.0;      ///< by the hand [m/s]
  double led_force = 0.0;      ///< of what touched it meanwhile [N]
};

/// Follows the true robot through its reaction.
class Follower {
 public:
  Follower(const SimulatedScenario& scenario, Answer& answer)
      : robot_(*scenario.robot.robot), limits_(scenario.control.faults.workspace), answer_(answer) {}

  void see(const test::ScenarioLoop& loop) {
    const Context& context = loop.context;
    const PlatformMotion& truth = context.get(loop.station.platform_truth);
    const ContactTruth& contact = context.get(loop.station.contact_truth);
    const ReactionMode mode = context.get(loop.control.reaction_state).mode;
    const double force = std::max(0.0, contact.strongest.strength());
    answer_.peak_force = std::max(answer_.peak_force, force);
    answer_.fault = answer_.fault || context.get(loop.control.gate).fault != GateFault::none;
    answer_.detected = answer_.detected || context.get(loop.control.detection).level != ContactLevel::none;
    if (answer_.detected) measure_place(truth);
    if (mode == ReactionMode::zero_g && !struck_) {
      struck_ = context.time();
      answer_.struck = true;
    }
    pose_ = truth.pose;
    if (struck_) measure_rest(context.time() - *struck_, truth, force);
    if (force > touched) last_force_ = contact.strongest.force_in_base;
  }
  std::optional<Time> struck() const { return struck_; }

  /// Where a hand pushes: away from what still touches the robot, otherwise to the middle.
  Eigen::Vector2d towards(bool still_touched) const {
    const Eigen::Vector2d wanted =
        still_touched ? Eigen::Vector2d(last_force_) : Eigen::Vector2d(-pose_.head<2>());
    return wanted.normalized();
  }

 private:
  void measure_place(const PlatformMotion& truth) {
    robot_.kinematics(truth.pose, truth.velocity, at_);
    answer_.lost = answer_.lost || !at_.valid;
    answer_.outside = answer_.outside || !is_within(limits_, robot_, at_);
    answer_.det_A = std::min(answer_.det_A, std::abs(at_.det_A));
    answer_.distance = std::max(answer_.distance, distance_from_centre(limits_, robot_, truth.pose));
    answer_.rotation = std::max(answer_.rotation, robot_.space().rotation_angle(truth.pose));
  }
  void measure_rest(Time after, const PlatformMotion& truth, double force) {
    if (truth.velocity.head(robot_.space().translations()).norm() < at_rest) {
      if (!answer_.rest) answer_.rest = to_seconds(after);
    } else {
      answer_.rest.reset();
      if (after > rest_asked) answer_.slow_force = std::max(answer_.slow_force, force);
    }
  }

  const ParallelRobot& robot_;
  const WorkspaceLimits& limits_;
  Answer& answer_;
  Kinematics at_;
  std::optional<Time> struck_;
  Configuration pose_;
  CartesianVector last_force_;
};

/// The same run up to then, and a hand that begins to push there.
void lead_by_hand(SimulatedScenario scenario, Time from, const Eigen::Vector2d& direction, Answer& answer) {
  Eigen::Vector3d push = Eigen::Vector3d::Zero();
  push.head<2>() = hand * direction;
  scenario.station.applied_wrench.push_back(
      {.peak_in_base = push, .start = from, .rise = 100ms, .hold = pushed, .fall = 0ms});
  test::ScenarioLoop loop(scenario);
  while (loop.context.time() < from + pushed) {
    loop.tick();
    if (loop.context.time() <= from) continue;
    const PlatformMotion& truth = loop.context.get(loop.station.platform_truth);
    answer.led_speed = std::max(answer.led_speed, truth.velocity.head<2>().norm());
    answer.led_force =
        std::max(answer.led_force, loop.context.get(loop.station.contact_truth).strongest.strength());
    answer.fault = answer.fault || loop.context.get(loop.control.gate).fault != GateFault::none;
  }
}

Answer answer_of(const CampaignRun& run) {
  Answer answer;
  answer.number = run.number;
  for (const auto& [key, value] : run.values)
    if (key == "contact") answer.body = value;
  test::ScenarioLoop loop(run.scenario);
  Follower follower(run.scenario, answer);
  const auto ends = [&] { return follower.struck() ? *follower.struck() + watched : run.scenario.duration; };
  while (loop.context.time() < ends()) {
    loop.tick();
    follower.see(loop);
  }
  if (!answer.struck) return answer;
  const bool still_touched = loop.context.get(loop.station.contact_truth).strongest.strength() > touched;
  lead_by_hand(run.scenario, ends(), follower.towards(still_touched), answer);
  return answer;
}

std::vector<Answer> answers(std::size_t draws, unsigned threads) {
  CampaignOverrides overrides;
  overrides.draws = draws;
  const Campaign campaign = read_campaign(
      std::filesystem::path(FLINCH_SOURCE_DIR) / "apps/campaigns/default_reaction.yaml", overrides);
  return test::in_parallel(
      campaign.runs(), [&](std::size_t number) { return answer_of(draw_run(campaign, number)); }, threads);
}

TEST(DefaultReaction, StaysWithinTheWorkspaceComesToRestAndLeavesARobotThatCanBePushedByHand) {
  std::size_t runs = 0, detected = 0, faults = 0, lost = 0, outside = 0, late = 0, stiff = 0;
  double det_A = 1.0, distance = 0.0, rotation = 0.0, peak = 0.0;
  double slowest = std::numeric_limits<double>::infinity();
  std::vector<double> rest;
  for (const Answer& run : answers(test::wanted<std::size_t>("FLINCH_RUNS", 10), 2)) {
    ++runs;
    detected += run.detected ? 1U : 0U;
    faults += run.fault ? 1U : 0U;
    lost += run.lost ? 1U : 0U;
    outside += run.outside ? 1U : 0U;
    det_A = std::min(det_A, run.det_A);
    distance = std::max(distance, run.distance);
    rotation = std::max(rotation, run.rotation);
    peak = std::max(peak, run.peak_force);
    if (!run.struck) continue;
    rest.push_back(run.rest.value_or(never));
    if (rest.back() > to_seconds(rest_asked)) {
      ++late;
      EXPECT_GT(run.slow_force, touched) << run.number << ": who does not rest is touched";
      std::printf("  late: number %zu, %s, %.0f ms; touched with up to %.1f N meanwhile\n", run.number,
                  run.body.c_str(), 1e3 * rest.back(), run.slow_force);
    }
    slowest = std::min(slowest, run.led_speed);
    if (run.led_speed < hand_speed) {
      ++stiff;
      EXPECT_GT(run.led_force, touched) << run.number << ": whom a hand does not lead is touched";
      std::printf("  stiff: number %zu, %s, %.3f m/s; touched with up to %.1f N\n", run.number,
                  run.body.c_str(), run.led_speed, run.led_force);
    }
  }
  std::printf(
      "%zu runs, %zu detected, %zu hard contacts of up to %.0f N: %zu faults, %zu without kinematics, %zu "
      "outside; det A %.3f, %.4f m, %.1f deg; at rest after %.0f ms (median), %.0f ms (95 %%), %.0f ms "
      "(longest), %zu not within 0.5 s; %.0f N lead at %.3f m/s and more, %zu below\n",
      runs, detected, rest.size(), peak, faults, lost, outside, det_A, distance,
      rotation * 180.0 / 3.14159265, 1e3 * test::quantile(rest, 0.5), 1e3 * test::quantile(rest, 0.95),
      1e3 * test::quantile(rest, 1.0), late, hand, slowest, stiff);
  EXPECT_GT(rest.size(), 0U);
  EXPECT_EQ(faults, 0U);
  EXPECT_EQ(lost, 0U);
  EXPECT_EQ(outside, 0U);
  const std::size_t soon = rest.size() - late;
  EXPECT_GE(clopper_pearson_upper(soon, rest.size(), 0.999), 0.95) << "at rest within 0.5 s";
  EXPECT_GE(clopper_pearson_upper(rest.size() - stiff, rest.size(), 0.999), 0.99) << "led by a hand";
}

}  // namespace
}  // namespace flinch
