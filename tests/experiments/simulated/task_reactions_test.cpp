// The experiments of [SafePR] V-B, V-D and V-E with laws that serve tasks by priority.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <map>
#include <string>

#include "experiments/simulated/experiment.h"
#include "experiments/simulated/simulated_scenario.h"
#include "experiments/verdict/recorded_truth.h"
#include "experiments/verdict/verdict.h"
#include "systems/config/config_file.h"
#include "systems/framework/recorded_values.h"
#include "systems/robot/link_segments.h"
#include "systems/signals/constraint_state.h"
#include "systems/signals/contact_detection.h"
#include "systems/signals/gate_status.h"
#include "systems/signals/torque_command.h"
#include "systems/signals/workspace_measures.h"

namespace flinch {
namespace {

/// A scenario with a word of its file replaced.
SimulatedScenario scenario(const std::string& name, const std::string& from = "",
                           const std::string& to = "") {
  const std::filesystem::path file = FLINCH_SOURCE_DIR "/apps/scenarios/" + name + ".yaml";
  std::string text = read_config_file(file);
  if (!from.empty()) text.replace(text.find(from), from.size(), to);
  return parse_simulated_scenario(text, file);
}

struct Shown {
  Verdict verdict;
  double largest_kappa = 0.0;
  double least_distance = 1.0;
  double last_kappa = 0.0;
  double last_distance = 0.0;
  int ticks_too_near = 0;
  int ticks_too_near_by_10_um = 0;
  int ticks_too_near_by_100_um = 0;
  int ticks_too_singular = 0;
  double largest_speed = 0.0;        ///< of the true platform [m/s]
  double largest_torque_step = 0.0;  ///< of what the laws ask for, while they are heard [Nm]
  bool lost_hold = false;            ///< the gate closed near a type-II singularity
};

Shown run(const SimulatedScenario& scenario) {
  const Recording recording = run_experiment(scenario);
  Shown shown;
  shown.verdict = judge(recording, scenario.robot.robot->space(), scenario.expected, scenario.force_limits);
  const auto measures = read<WorkspaceMeasures>(recording, "measures");
  const auto truth = read<RecordedTruth>(recording, "truth");
  const auto gate = read<GateStatus>(recording, "gate");
  const auto asked = read<TorqueCommand>(recording, "requested_torque");
  JointVector before;
  for (std::size_t k = 0; k < recording.samples(); ++k) {
    const WorkspaceMeasures now = measures[k];
    if (!now.valid) continue;
    shown.largest_kappa = std::max(shown.largest_kappa, now.sigma_kappa);
    shown.least_distance = std::min(shown.least_distance, now.sigma_sc);
    shown.ticks_too_near += now.sigma_sc < 0.17 - 1e-6 ? 1 : 0;
    shown.ticks_too_near_by_10_um += now.sigma_sc < 0.17 - 1e-5 ? 1 : 0;
    shown.ticks_too_near_by_100_um += now.sigma_sc < 0.17 - 1e-4 ? 1 : 0;
    shown.ticks_too_singular += now.sigma_kappa > 15.0 + 1e-6 ? 1 : 0;
    shown.largest_speed = std::max(shown.largest_speed, truth[k].velocity.head(2).norm());
    shown.last_kappa = now.sigma_kappa;
    shown.last_distance = now.sigma_sc;
    shown.lost_hold |= gate[k].fault == GateFault::type_2_singularity;
    const TorqueCommand torque = asked[k];
    const bool heard = gate[k].phase == GatePhase::open && torque.valid;
    if (heard && before.size() > 0) {
      shown.largest_torque_step =
          std::max(shown.largest_torque_step, (torque.torque - before).lpNorm<Eigen::Infinity>());
    }
    before = heard ? torque.torque : JointVector();
  }
  return shown;
}

// [SafePR] V-B: less than 10 mm on every level, and orientations that are nearer on the acceleration and the
// torque level than on the velocity level, which is up to 9 degrees off there. Here the torque level's is
// not, docs/theory.md.
TEST(TaskTracking, FollowsTheSquareOnEveryLevel) {
  std::map<std::string, double> orientation;  // largest error [rad]
  for (const std::string level : {"velocity", "acceleration", "torque"}) {
    const Shown shown = run(scenario("square_tasks", "[torque_tracking]", "[" + level + "_tracking]"));
    EXPECT_TRUE(shown.verdict.good()) << level;
    EXPECT_LT(shown.verdict.max_tracking_error, 0.010) << level;
    orientation[level] = shown.verdict.max_orientation_error;
    EXPECT_LT(orientation[level], 0.5 * M_PI / 180.0) << level;
    std::printf("  %s level: %.2f mm, %.3f deg\n", level.c_str(), 1e3 * shown.verdict.max_tracking_error,
                orientation[level] * 180.0 / M_PI);
  }
  EXPECT_LT(orientation["acceleration"], orientation["velocity"]);
}

// [SafePR] V-D, left.
TEST(TaskReaction, WithoutConstraintsARetreatEndsInASingularity) {
  EXPECT_TRUE(run(scenario("reaction_near_singularity", "kept: after_contact", "kept: never")).lost_hold);
}
TEST(TaskReaction, WithConstraintsItStopsAtTheConditionNumber) {
  const Shown shown = run(scenario("reaction_near_singularity"));
  EXPECT_TRUE(shown.verdict.good());
  EXPECT_FALSE(shown.lost_hold);
  EXPECT_NEAR(shown.last_kappa, 15.0, 0.15);
  EXPECT_GT(shown.last_distance, 0.17 - 0.002);
  EXPECT_LE(shown.largest_torque_step, 20.0 + 1e-9);
}

// [SafePR] V-D, right. Links are 60 mm thick.
TEST(TaskReaction, WithoutConstraintsARetreatEndsInASelfCollision) {
  EXPECT_LT(run(scenario("reaction_near_itself", "kept: after_contact", "kept: never")).least_distance, 0.06);
}
TEST(TaskReaction, WithConstraintsLegsStayApart) {
  const Shown shown = run(scenario("reaction_near_itself"));
  EXPECT_TRUE(shown.verdict.good());
  EXPECT_GT(shown.least_distance, 0.12);
  EXPECT_NEAR(shown.last_distance, 0.17, 0.002);
  EXPECT_LT(shown.last_kappa, 15.15);
  EXPECT_LE(shown.largest_torque_step, 20.0 + 1e-9);
}

/// How the retreats of V-D end on a true robot, which need not be what its controller believes.
struct TrueRetreat {
  double first_distance = 0.0;  ///< between links, at the start [m]
  double largest_kappa = 0.0;   ///< from the detection on, as the next
  double least_distance = 1.0;  ///< [m]
  double last_speed = 0.0;      ///< of the platform [m/s]
  bool detected = false;
  bool is_lost = false;  ///< at a tick the true robot had no kinematics: what is above leaves that out
  std::string fault;
};

TrueRetreat retreat(const std::string& name, const std::string& law, const std::string& limits,
                    const std::string& plant, int seed) {
  const std::filesystem::path file = FLINCH_SOURCE_DIR "/apps/scenarios/" + name + ".yaml";
  std::string text = read_config_file(file);
  const auto replace = [&text](const std::string& from, const std::string& to) {
    ASSERT_NE(text.find(from), std::string::npos) << from;
    text.replace(text.find(from), from.size(), to);
  };
  replace("[torque_reaction]", "[" + law + "]");
  replace("limits: {keep: never}", limits);
  replace("kept: after_contact", "kept: never");
  replace("\nexpect:", "\nplant: {classification: truth" + plant + "}\n\nexpect:");
  replace("seed: 1", "seed: " + std::to_string(seed));
  const SimulatedScenario scenario = parse_simulated_scenario(text, file);
  const Recording recording = run_experiment(scenario);
  TrueRetreat shown;
  const auto truths = read<RecordedTruth>(recording, "truth");
  const auto detections = read<ContactDetection>(recording, "detection");
  const Mechanism& robot = *scenario.robot.robot;
  for (std::size_t k = 0; k < recording.samples(); ++k) {
    const RecordedTruth truth = truths[k];
    Kinematics at;
    robot.kinematics(truth.pose, truth.velocity, at);
    if (!at.valid) shown.is_lost = true;
    if (k == 0) shown.first_distance = self_collision_distance(robot, at);
    shown.detected |= detections[k].level != ContactLevel::none;
    if (!shown.detected) continue;
    shown.largest_kappa = std::max(shown.largest_kappa, at.sigma_kappa);
    shown.least_distance = std::min(shown.least_distance, self_collision_distance(robot, at));
    shown.last_speed = truth.velocity.norm();
  }
  shown.fault =
      judge(recording, scenario.robot.robot->space(), scenario.expected, scenario.force_limits).fault;
  return shown;
}

constexpr int drawn_robots = 12;
const std::string ideal;
const std::string realistic = ", realism: bench";

// [SafePR] V-D on the strict level: neither a singularity nor a self-collision, and no limit is overshot. One
// of the scenarios starts beyond that of self-collision, and gets no further.
TEST(TheStrictReaction, RetreatsWithinBothLimits) {
  for (const std::string name : {"reaction_near_singularity", "reaction_near_itself"}) {
    for (const std::string& plant : {ideal, realistic}) {
      TrueRetreat worst;
      for (int seed = 1; seed <= (plant.empty() ? 1 : drawn_robots); ++seed) {
        const TrueRetreat shown = retreat(name, "strict_reaction", "limits: {keep: always}", plant, seed);
        EXPECT_TRUE(shown.detected) << name << plant << " " << seed;
        EXPECT_FALSE(shown.is_lost) << name << plant << " " << seed;
        EXPECT_EQ(shown.fault, "") << name << plant << " " << seed;
        EXPECT_LE(shown.largest_kappa, 15.0) << name << plant << " " << seed;
        EXPECT_GE(shown.least_distance, std::min(0.17, shown.first_distance)) << name << plant << " " << seed;
        EXPECT_LT(shown.last_speed, 0.02) << name << plant << " " << seed;
        worst.largest_kappa = std::max(worst.largest_kappa, shown.largest_kappa);
        worst.least_distance = std::min(worst.least_distance, shown.least_distance);
      }
      std::printf("  %s%s: sigma_kappa up to %.2f, sigma_sc down to %.4f m\n", name.c_str(), plant.c_str(),
                  worst.largest_kappa, worst.least_distance);
    }
  }
}
TEST(TheStrictReaction, WouldEndInASingularityOrInItselfWithoutLimitsOnRealisticRobotsToo) {
  int lost_hold = 0, collided = 0;
  for (int seed = 1; seed <= drawn_robots; ++seed) {
    const std::string none = "limits: {keep: never}";
    lost_hold +=
        retreat("reaction_near_singularity", "torque_reaction", none, realistic, seed).fault.empty() ? 0 : 1;
    collided +=
        retreat("reaction_near_itself", "torque_reaction", none, realistic, seed).least_distance < 0.06 ? 1
                                                                                                        : 0;
  }
  EXPECT_EQ(lost_hold, drawn_robots);
  std::printf("  without limits %d of %d robots get lost, %d of %d come nearer than 60 mm\n", lost_hold,
              drawn_robots, collided, drawn_robots);
  EXPECT_GE(collided, drawn_robots / 2);
}

// [SafePR] V-E, where at 1.25 to 1.35 m/s both measures reach their safety values and overshoot, the distance
// for 100 ms at most, and most on the acceleration level; docs/theory.md.
TEST(TaskTracking, KeepsBothConstraintsWithoutAContact) {
  for (const std::string level : {"velocity", "acceleration", "torque"}) {
    const Shown shown =
        run(scenario("constraints_without_contact", "[torque_tracking]", "[" + level + "_tracking]"));
    std::printf(
        "  %s level: %.2f m/s; kappa %.2f, above 15 for %d ms, at last %.2f; sc %.4f m, below 0.17 m for %d "
        "ms, by 10 um for %d ms, by 100 um for %d ms, at last %.4f m\n",
        level.c_str(), shown.largest_speed, shown.largest_kappa, shown.ticks_too_singular, shown.last_kappa,
        shown.least_distance, shown.ticks_too_near, shown.ticks_too_near_by_10_um,
        shown.ticks_too_near_by_100_um, shown.last_distance);
    EXPECT_TRUE(shown.verdict.good()) << level;
    EXPECT_GT(shown.largest_speed, 1.25) << level;
    EXPECT_NEAR(shown.last_kappa, 15.0, 0.05) << level;
    EXPECT_NEAR(shown.last_distance, 0.17, 0.0005) << level;
    EXPECT_LT(shown.largest_kappa, 15.5) << level;
    EXPECT_GT(shown.least_distance, 0.169) << level;
  }
  EXPECT_LT(run(scenario("constraints_without_contact", "kept: always", "kept: never")).least_distance, 0.15);
}

// Every sort of contact, on every level: detected, answered, released, and no fault.
TEST(TaskReaction, AnswersEverySortOfContactOnEveryLevel) {
  for (const std::string body : {"platform", "first_link", "second_link", "clamping"}) {
    for (const std::string level : {"velocity", "acceleration", "torque"}) {
      const Shown shown = run(scenario(body + "_reaction", "[torque_reaction]", "[" + level + "_reaction]"));
      EXPECT_TRUE(shown.verdict.good()) << body << " " << level;
      ASSERT_EQ(shown.verdict.contacts.size(), 1U) << body << " " << level << ": it closes again";
      const ContactVerdict& contact = shown.verdict.contacts.front();
      ASSERT_TRUE(contact.removed);
      EXPECT_LT(*contact.removed - contact.onset, body == "clamping" ? 0.275 : 0.125) << body << " " << level;
      EXPECT_LE(shown.largest_torque_step, 20.0 + 1e-9) << body << " " << level;
    }
  }
}

}  // namespace
}  // namespace flinch
