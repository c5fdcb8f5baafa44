// From wherever a reaction or a fault leaves the robot, an operator brings it back to its nominal motion by
// the one sequence of docs/faults.md, as apps/scenarios/brought_back.yaml has it. Random contacts on robots
// that differ from their model; what was touched stays where it is, and may be in the way. FLINCH_RUNS in
// the environment says how many of each body; 250 are all of apps/campaigns/reaction_1000_oracle.yaml.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "diagrams/operator_ports.h"
#include "experiments/campaign/campaign.h"
#include "experiments/campaign/campaign_run.h"
#include "experiments/simulated/closed_loop.h"
#include "plant/sundials_integrator.h"
#include "systems/framework/diagram_builder.h"
#include "systems/framework/simulator.h"
#include "systems/robot/workspace_limits.h"
#include "tests/support/in_parallel.h"
#include "tests/support/wanted.h"

namespace flinch {
namespace {

using enum ReactionMode;

const std::filesystem::path shipped = std::filesystem::path(FLINCH_SOURCE_DIR) / "apps";

constexpr Time longest_run = 30s;
constexpr double longest_return = 20.0;  // from the first reset to the start of the nominal motion [s]
constexpr double overshoot = 1.2;        // of the true speed over the largest that is planned
constexpr double arrived = 1e-4;         // distance of the reference from the start of the motion [m]
constexpr double largest_error = 0.01;   // of the true platform there [m]

/// One run, up to the nominal motion that an operator has begun again.
struct Way {
  std::size_t number = 0;           ///< of the run
  std::string end;                  ///< where it began; "": the robot has not ended
  bool outside = false;             ///< it stood beyond a limit of the gate then
  bool touched = false;             ///< and in contact
  bool crossed = false;             ///< and beyond a type-II singularity, in another assembly mode
  int resets = 0;                   ///< until then
  int touched_again = 0;            ///< new reactions on the way, to what truly touches the robot
  int false_reactions = 0;          ///< and to nothing
  std::vector<GateFault> faults{};  ///< for which the gate closed again
  std::optional<double> duration;  ///< from the first reset to the start of the motion [s]; none: not reached
  double error = 0.0;  ///< distance of the true platform from the start then, unless something touches it [m]
  double recovering = 0.0;  ///< largest speed of the platform in `recover` [m/s]
  double nominal = 0.0;     ///< and in `nominal`
};

/// The closed loop of a scenario with an operator who does as the script says.
struct Loop {
  Loop(const SimulatedScenario& scenario, const OperatorScript& script)
      : parts(add_closed_loop(builder, scenario, scenario.control)),
        buttons(add_scripted_operator(builder, parts.control, script).buttons),
        diagram(builder.build()),
        simulator(*diagram, std::make_unique<SundialsIntegrator>()),
        context(diagram->make_context()) {}

  DiagramBuilder builder{"experiment", 1ms};
  StationAndControl parts;
  OutputPort<OperatorCommand> buttons;
  std::unique_ptr<const Diagram> diagram;
  Simulator simulator;
  Context context;
};

/// What the robot does at a tick.
struct Present {
  ReactionMode mode = stopped;
  GateStatus gate;
};

std::string end_of(const Present& before) {
  if (before.mode == hold) return "hold";
  if (before.mode == zero_g) return "zero_g";
  return "fault " + std::to_string(static_cast<int>(before.gate.fault));
}

/// Follows one run.
class Follower {
 public:
  explicit Follower(const SimulatedScenario& scenario)
      : robot_(*scenario.robot.robot),
        limits_(scenario.robot.limits),
        start_(scenario.control.trajectory.path->start()) {}

  void see(const Loop& loop, Way& way) {
    const Context& context = loop.context;
    const Present now{context.get(loop.parts.control.reaction_state).mode,
                      context.get(loop.parts.control.gate)};
    const PlatformMotion& truth = context.get(loop.parts.station.platform_truth);
    const OperatorCommand& pressed = context.get(loop.buttons);
    if (pressed.reset && way.resets++ == 0) begin(loop, truth, way);
    const bool touches = context.get(loop.parts.station.contact_truth).strongest.body >= 0;
    if (way.resets > 0) measure(now, truth, touches, way);
    starts_ = (starts_ || pressed.start) && now.mode == nominal;
    const PlatformReference& wanted = context.get(loop.parts.control.reference);
    if (starts_ && wanted.valid && distance_from_start(wanted.pose) < arrived) {
      way.duration = to_seconds(context.time() - reset_);
      if (!touches) way.error = distance_from_start(truth.pose);
    }
    before_ = now;
  }

 private:
  double distance_from_start(const Configuration& pose) const {
    return (pose - start_).head(robot_.space().translations()).norm();
  }
  void begin(const Loop& loop, const PlatformMotion& truth, Way& way) {
    reset_ = loop.context.time();
    way.end = end_of(before_);
    Kinematics at, home;
    robot_.kinematics(truth.pose, truth.velocity, at);
    robot_.kinematics(robot_.home_pose(), PlatformVector::Zero(robot_.dof()), home);
    way.crossed = at.det_A * home.det_A <= 0.0;
    way.outside = !is_within(limits_, robot_, at);
    way.touched = loop.context.get(loop.parts.station.contact_truth).strongest.body >= 0;
  }
  void measure(const Present& now, const PlatformMotion& truth, bool touches, Way& way) const {
    if (before_.gate.passes() && !now.gate.passes()) way.faults.push_back(now.gate.fault);
    if (now.mode == react && before_.mode != react) ++(touches ? way.touched_again : way.false_reactions);
    const double speed = truth.velocity.head(robot_.space().translations()).norm();
    if (now.mode == recover) way.recovering = std::max(way.recovering, speed);
    if (now.mode == nominal) way.nominal = std::max(way.nominal, speed);
  }

  const ParallelRobot& robot_;
  const WorkspaceLimits& limits_;
  Configuration start_;
  Present before_;
  Time reset_{};
  bool starts_ = false;  ///< the nominal motion has begun again, and nothing has interrupted it
};

/// The sequence of the documents, with a target to which a robot comes back inside by the way that it came.
OperatorScript sequence_of(const Scenario& scenario) {
  OperatorScript script = read_simulated_scenario(shipped / "scenarios/brought_back.yaml").operator_script;
  for (OperatorEvent& event : script.events) {
    if (event.target.kind == TargetCommand::Kind::pose)
      event.target.pose = scenario.control.trajectory.path->start();
  }
  return script;
}

Way follow(const CampaignRun& run) {
  Way way;
  way.number = run.number;
  Loop loop(run.scenario, sequence_of(run.scenario));
  Follower follower(run.scenario);
  while (loop.context.time() < longest_run && !way.duration) {
    loop.simulator.step(loop.context);
    follower.see(loop, way);
    if (way.resets == 0 && loop.context.time() > run.scenario.duration + 3s) break;  // nothing interrupted it
  }
  return way;
}

/// `set` as of `flinch campaign --set`.
std::vector<Way> follow_all(const std::string& file, const std::vector<std::string>& set = {}) {
  CampaignOverrides overrides;
  overrides.draws = test::wanted<std::size_t>("FLINCH_RUNS", 12);
  overrides.set = set;
  const Campaign campaign = read_campaign(shipped / "campaigns" / file, overrides);
  return test::in_parallel(
      campaign.runs(), [&](std::size_t run) { return follow(draw_run(campaign, run)); }, 2);
}

void print(const std::vector<Way>& ways) {
  std::map<std::string, std::vector<const Way*>> by_end;
  for (const Way& way : ways) {
    const std::string end = way.end.empty() ? "not interrupted" : way.end;
    by_end[end + (way.outside ? ", outside" : "") + (way.crossed ? ", crossed" : "") +
           (way.touched ? ", in contact" : "")]
        .push_back(&way);
  }
  for (const auto& [end, all] : by_end) {
    int back = 0, blocked = 0, resets = 0;
    std::size_t faults = 0;
    double longest = 0.0;
    for (const Way* const way : all) {
      back += way->duration ? 1 : 0;
      longest = std::max(longest, way->duration.value_or(0.0));
      resets = std::max(resets, way->resets);
      blocked += way->touched_again > 0 ? 1 : 0;
      faults += way->faults.size();
    }
    std::printf("  %-32s %3zu, back %3d, longest %5.2f s; most resets %d, touched again %d, faults %zu\n",
                end.c_str(), all.size(), back, longest, resets, blocked, faults);
  }
}

/// Where drives cannot lead the platform back, the gate must not let them try.
void expect_stays(const Way& way) {
  EXPECT_FALSE(way.duration) << way.number;
  EXPECT_EQ(way.recovering, 0.0) << way.number;
  EXPECT_EQ(way.nominal, 0.0) << way.number;
}

void expect_all_back(const std::vector<Way>& ways) {
  print(ways);
  int back = 0;
  double recovering = 0.0, nominal = 0.0, error = 0.0;
  for (const Way& way : ways) {
    if (way.end.empty()) continue;
    if (way.crossed) {
      expect_stays(way);
      continue;
    }
    const double duration = way.duration.value_or(way.touched_again > 0 ? 0.0 : INFINITY);
    EXPECT_LT(duration, longest_return) << "run " << way.number << " from " << way.end;
    EXPECT_EQ(way.false_reactions, 0) << "run " << way.number << " from " << way.end;
    EXPECT_TRUE(way.faults.empty()) << "run " << way.number << " from " << way.end;
    back += way.duration ? 1 : 0;
    recovering = std::max(recovering, way.recovering);
    nominal = std::max(nominal, way.nominal);
    error = std::max(error, way.error);
  }
  std::printf("  at most %.3f m/s in recover, %.3f m/s in nominal; at most %.1f mm off the start\n",
              recovering, nominal, 1e3 * error);
  const PlatformTrajectorySettings planned;
  EXPECT_LT(recovering, overshoot * planned.recovery.translation.velocity);
  EXPECT_LT(nominal, overshoot * planned.approach.translation.velocity);
  EXPECT_LT(error, largest_error);
  EXPECT_GT(back, 0);
}

TEST(BroughtBack, FromWhereReactionsOfAllLevelsEnd) {
  expect_all_back(follow_all("reaction_1000_oracle.yaml"));
}

TEST(BroughtBack, FromWhereReactionsEndThatKeepNoLimits) {
  expect_all_back(follow_all("reaction_1000_papers_oracle.yaml"));
}

TEST(BroughtBack, FromZeroGravityAfterHardContacts) {
  expect_all_back(follow_all("reaction_1000_oracle.yaml", {"control.sequence.zero_g_when_struck=true"}));
}

}  // namespace
}  // namespace flinch
