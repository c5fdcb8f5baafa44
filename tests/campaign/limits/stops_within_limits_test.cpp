// What becomes of the robot's limits where it is stopped in the middle of a reaction that kept them, on
// robots that differ from their model. FLINCH_RUNS in the environment says how many of each body; 250 are
// all.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <optional>
#include <vector>

#include "experiments/campaign/campaign.h"
#include "experiments/campaign/campaign_run.h"
#include "systems/robot/link_segments.h"
#include "tests/campaign/limits/reactions_within_limits.h"
#include "tests/fault/scenario_loop.h"
#include "tests/support/in_parallel.h"
#include "tests/support/wanted.h"

namespace flinch {
namespace {

using test::at_rest;
using test::sigma_kappa_s;
using test::sigma_sc_s;

constexpr Time watched = 500ms;  // after the button
constexpr double touched = 1.0;  // [N]

/// From the tick on at which the operator stops the robot.
struct Stop {
  bool begins_inside = false;
  double sigma_kappa = 0.0;    ///< the largest
  double sigma_sc = 1.0;       ///< the smallest [m]
  std::optional<double> rest;  ///< until the platform stays slower than `at_rest` [s]
  bool brakes = false;         ///< the stop by torques ended in the brakes
  double late_force = 0.0;     ///< of what touched it in the last 100 ms [N]
};

class Measured {
 public:
  explicit Measured(const ParallelRobot& robot) : robot_(robot) {}

  void see(const PlatformMotion& truth, double time, Stop& stop) {
    robot_.kinematics(truth.pose, truth.velocity, at_);
    stop.sigma_kappa = std::max(stop.sigma_kappa, at_.sigma_kappa);
    stop.sigma_sc = std::min(stop.sigma_sc, self_collision_distance(robot_, at_));
    const bool rests = truth.velocity.head(robot_.space().translations()).norm() < at_rest;
    if (!rests) {
      stop.rest.reset();
    } else if (!stop.rest) {
      stop.rest = time;
    }
  }
  bool is_inside() const {
    return at_.sigma_kappa <= sigma_kappa_s && self_collision_distance(robot_, at_) >= sigma_sc_s;
  }

 private:
  const ParallelRobot& robot_;
  Kinematics at_;
};

/// Lets the contact be detected, presses the stop button `after` that, and looks on for half a second.
/// Nothing where the contact is not detected, or something else has closed the gate.
std::optional<Stop> stop_in_reaction(const SimulatedScenario& scenario, Time after) {
  test::ScenarioLoop loop(scenario);
  Context& context = loop.context;
  std::optional<Time> pressed;
  Stop stop;
  Measured measured(*scenario.robot.robot);
  while (context.time() < scenario.duration && !pressed) {
    loop.tick();
    const ReactionState& reaction = context.get(loop.control.reaction_state);
    if (reaction.mode == ReactionMode::react && context.time() - reaction.since >= after)
      pressed = context.time();
  }
  if (!pressed || context.get(loop.control.gate).phase != GatePhase::open) return std::nullopt;
  measured.see(context.get(loop.station.platform_truth), 0.0, stop);
  stop.begins_inside = measured.is_inside();
  context.set(loop.buttons, OperatorCommand{.stop = true});
  while (context.time() < *pressed + watched) {
    loop.tick();
    measured.see(context.get(loop.station.platform_truth), to_seconds(context.time() - *pressed), stop);
    if (context.time() > *pressed + watched - 100ms)
      stop.late_force =
          std::max(stop.late_force, context.get(loop.station.contact_truth).strongest.strength());
  }
  stop.brakes = context.get(loop.control.brake).engage;
  return stop;
}

std::vector<Stop> stop_in_reactions(std::size_t draws, unsigned threads) {
  CampaignOverrides overrides;
  overrides.draws = draws;
  const Campaign campaign = read_campaign(
      std::filesystem::path(FLINCH_SOURCE_DIR) / "apps/campaigns/reaction_1000_oracle.yaml", overrides);
  const auto stop_of = [&](std::size_t number) -> std::optional<Stop> {
    const CampaignRun run = draw_run(campaign, number);
    if (followed_name(run.scenario.control.stages.reaction_laws) != "strict_reaction") return std::nullopt;
    return stop_in_reaction(run.scenario, std::chrono::milliseconds(run.draw % 60));
  };
  std::vector<Stop> stops;
  for (const std::optional<Stop>& stop : test::in_parallel(campaign.runs(), stop_of, threads))
    if (stop) stops.push_back(*stop);
  return stops;
}

TEST(AStopInTheMiddleOfAReaction, KeepsTheLimitsThatTheReactionKept) {
  std::size_t n = 0, kappa = 0, sc = 0, brakes = 0, restless = 0;
  double sigma_kappa = 0.0, sigma_sc = 1.0;
  double least_late_force = std::numeric_limits<double>::infinity();
  std::vector<double> rest;
  for (const Stop& stop : stop_in_reactions(test::wanted<std::size_t>("FLINCH_RUNS", 10), 2)) {
    if (!stop.begins_inside) continue;
    ++n;
    kappa += stop.sigma_kappa > sigma_kappa_s * (1.0 + 1e-6) ? 1U : 0U;
    sc += stop.sigma_sc < sigma_sc_s * (1.0 - 1e-6) ? 1U : 0U;
    brakes += stop.brakes ? 1U : 0U;
    restless += stop.rest ? 0U : 1U;
    if (!stop.rest) {
      least_late_force = std::min(least_late_force, stop.late_force);
      EXPECT_GT(stop.late_force, touched) << "who does not rest is touched";
    }
    if (stop.rest) rest.push_back(*stop.rest);
    sigma_kappa = std::max(sigma_kappa, stop.sigma_kappa);
    sigma_sc = std::min(sigma_sc, stop.sigma_sc);
  }
  std::sort(rest.begin(), rest.end());
  const double half = rest.empty() ? 0.0 : rest[rest.size() / 2];
  std::printf(
      "%zu stops, beyond kappa %zu, sc %zu; worst kappa %.2f, sc %.4f m; at rest after %.0f ms (median), "
      "%.0f ms "
      "(longest), %zu not within 0.5 s, touched by %.1f N and more until then; %zu ended in the brakes\n",
      n, kappa, sc, sigma_kappa, sigma_sc, 1e3 * half, rest.empty() ? 0.0 : 1e3 * rest.back(), restless,
      least_late_force, brakes);
  EXPECT_GT(n, 0U);
  EXPECT_EQ(kappa, 0U);
  EXPECT_EQ(sc, 0U);
}

}  // namespace
}  // namespace flinch
