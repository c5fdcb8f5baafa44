#include "tests/campaign/limits/reactions_within_limits.h"

#include <algorithm>
#include <cmath>

#include "experiments/campaign/campaign.h"
#include "experiments/campaign/campaign_run.h"
#include "experiments/simulated/experiment.h"
#include "experiments/verdict/recorded_truth.h"
#include "systems/framework/recorded_values.h"
#include "systems/laws/safety_filter.h"
#include "systems/robot/contact_jacobian.h"
#include "systems/robot/link_segments.h"
#include "systems/safety/fault_table.h"
#include "systems/signals/braking_status.h"
#include "systems/signals/contact_detection.h"
#include "systems/signals/gate_status.h"
#include "systems/signals/limit_status.h"
#include "systems/signals/reaction_state.h"
#include "tests/campaign/limits/unavoidable_force.h"
#include "tests/support/in_parallel.h"

namespace flinch::test {
namespace {

constexpr double touched = 1.0;         // [N]
constexpr double released_after = 0.1;  // [s]

std::string value_of(const CampaignRun& run, const std::string& key) {
  for (const auto& [name, value] : run.values) {
    if (name == key) return value;
  }
  return "";
}

double number_of(const CampaignRun& run, const std::string& key) {
  const std::string text = value_of(run, key);
  return text.empty() ? 0.0 : std::stod(text);
}

std::string kind_of(const std::string& body) {
  return body.starts_with("leg") ? body.substr(body.find('_') + 1) : body;
}

/// Follows when the robot is touched. What was over before anything was detected is not what it answers.
class Touching {
 public:
  void see(double time, double force, ReactionOutcome& outcome) {
    if (force > touched) {
      const bool again = last_ && time - *last_ > released_after;
      if (!onset_ || (again && !outcome.detected)) {
        onset_ = time;
      } else if (again) {
        outcome.reclosed = true;
      }
      if (!outcome.reclosed) last_ = time;
      still_ = true;
    } else {
      still_ = false;
    }
    outcome.peak_force = std::max(outcome.peak_force, force);
  }
  void finish(ReactionOutcome& outcome) const {
    if (onset_ && last_ && !still_) outcome.removed = *last_ - *onset_;
  }

 private:
  std::optional<double> onset_, last_;
  bool still_ = false;
};

/// Follows how fast a robot that holds its place moves though nothing touches it.
class Holding {
 public:
  void see(double time, ReactionMode mode, double force, double speed, ReactionOutcome& outcome) {
    if (force > touched || mode != ReactionMode::hold) since_ = time;
    if (time - since_ > released_after) outcome.held_speed = std::max(outcome.held_speed, speed);
  }

 private:
  double since_ = 0.0;
};

void measure_place(const Mechanism& robot, const RecordedTruth& truth, ReactionOutcome& outcome) {
  Kinematics at;
  robot.kinematics(truth.pose, truth.velocity, at);
  if (!at.valid) outcome.is_lost = true;
  outcome.sigma_kappa = std::max(outcome.sigma_kappa, at.sigma_kappa);
  outcome.sigma_sc = std::min(outcome.sigma_sc, self_collision_distance(robot, at));
  outcome.det_A = std::min(outcome.det_A, std::abs(at.det_A));
  outcome.distance = std::max(outcome.distance, truth.pose.head(robot.space().translations()).norm());
  outcome.rotation = std::max(outcome.rotation, robot.space().rotation_angle(truth.pose));
}

/// Whether the true robot can stop within the safety values from here: straight, in the shortest time that 70
/// Nm allow at the beginning, looked at in ten places. (Its own lines, and not those of the braking set.)
bool can_stop_inside(const Mechanism& robot, const RecordedTruth& truth) {
  constexpr double most_torque = 70.0;
  Kinematics at;
  Dynamics dynamics;
  robot.kinematics(truth.pose, truth.velocity, at);
  robot.dynamics(at, dynamics);
  if (!at.valid || !dynamics.valid) return false;
  double stop = 5e-3;
  for (; stop < 1.0; stop *= 1.05) {
    const PlatformVector wrench = dynamics.M_x * (-truth.velocity / stop) + dynamics.C_x * truth.velocity +
                                  dynamics.g_x + dynamics.F_fr_x;
    if (drive_torques(at, wrench).lpNorm<Eigen::Infinity>() <= most_torque) break;
  }
  for (int k = 0; k <= 10; ++k) {
    const double t = 0.1 * k * stop;
    const PlatformVector way = truth.velocity * (t - 0.5 * t * t / stop);
    robot.kinematics(robot.space().plus(truth.pose, way), PlatformVector::Zero(robot.dof()), at);
    if (!(at.sigma_kappa <= sigma_kappa_s && self_collision_distance(robot, at) >= sigma_sc_s)) return false;
  }
  return true;
}

/// At the first tick at which the robot has judged.
void note_stop(const Mechanism& robot, const RecordedTruth& truth, const BrakingStatus& braking,
               ReactionOutcome& outcome) {
  if (!braking.valid || outcome.says_it_could_stop) return;
  outcome.says_it_could_stop = braking.stays_inside;
  outcome.could_stop = can_stop_inside(robot, truth);
}

/// At the first tick of the contact.
void measure_unavoidable(const CampaignRun& run, const RecordedTruth& truth, const RecordedContact& contact,
                         ReactionOutcome& outcome) {
  constexpr double next_tick = 1e-3, later = 5e-3;
  outcome.touched = true;
  const double stiffness = number_of(run, "pylon.stiffness_N_per_m");
  if (stiffness <= 0.0) return;
  const Mechanism& robot = *run.scenario.robot.robot;
  outcome.unavoidable = unavoidable_force(robot, truth, contact, stiffness, {.begins_after = next_tick});
  outcome.unavoidable_later =
      unavoidable_force(robot, truth, contact, stiffness, {.begins_after = next_tick + later});
}

ReactionOutcome outcome_of(const CampaignRun& run) {
  ReactionOutcome outcome;
  outcome.number = run.number;
  outcome.law = followed_name(run.scenario.control.stages.reaction_laws);
  outcome.body = kind_of(value_of(run, "contact"));
  const Recording recording = run_for_signals(
      run.scenario, {"truth", "contact", "gate", "detection", "reaction", "limits", "braking"});
  const RecordedValues<RecordedTruth> truths(recording, "truth");
  const RecordedValues<RecordedContact> contacts(recording, "contact");
  const RecordedValues<GateStatus> gates(recording, "gate");
  const RecordedValues<ContactDetection> detections(recording, "detection");
  const RecordedValues<ReactionState> modes(recording, "reaction");
  const RecordedValues<LimitStatus> limits(recording, "limits");
  const RecordedValues<BrakingStatus> brakings(recording, "braking");
  const Mechanism& robot = *run.scenario.robot.robot;
  outcome.speed = number_of(run, "motion.speed_m_per_s");
  const int translations = robot.space().translations();
  const SafetyFilterSettings& kept = run.scenario.control.limits;
  const bool from_the_start = kept.use == SafetyFilterSettings::Use::always;
  const bool keeps_safety_values = kept.limits.max_condition_number <= sigma_kappa_s &&
                                   kept.limits.workspace.min_self_collision_distance >= sigma_sc_s;
  Touching touching;
  Holding holding;
  for (std::size_t k = 0; k < recording.samples(); ++k) {
    const double time = to_seconds(Time(recording.time_ns[k]));
    const RecordedContact contact = contacts[k];
    touching.see(time, contact.strongest.force_in_base.norm(), outcome);
    if (const GateStatus gate = gates[k]; gate.fault != GateFault::none && outcome.fault.empty())
      outcome.fault = fault_table()[static_cast<std::size_t>(gate.fault) - 1].description;
    const LimitStatus limit = limits[k];
    outcome.slack = std::max(outcome.slack, limit.slack);
    outcome.steps = std::max(outcome.steps, static_cast<int>(limit.steps));
    const RecordedTruth truth = truths[k];
    holding.see(time, modes[k].mode, contact.strongest.force_in_base.norm(),
                truth.velocity.head(translations).norm(), outcome);
    if (contact.in_contact && !outcome.touched) measure_unavoidable(run, truth, contact, outcome);
    const bool is_detected = outcome.detected || detections[k].level != ContactLevel::none;
    if (k == 0 || from_the_start || is_detected) measure_place(robot, truth, outcome);
    if (k == 0) {
      outcome.starts_inside = outcome.sigma_kappa <= sigma_kappa_s && outcome.sigma_sc >= sigma_sc_s;
    }
    if (!is_detected) continue;
    outcome.detected = true;
    if (keeps_safety_values) note_stop(robot, truth, brakings[k], outcome);
  }
  touching.finish(outcome);
  return outcome;
}

}  // namespace

std::vector<ReactionOutcome> run_reactions(const std::filesystem::path& file, std::size_t draws, int threads,
                                           const std::vector<std::string>& set) {
  CampaignOverrides overrides;
  overrides.draws = draws;
  overrides.set = set;
  const Campaign campaign = read_campaign(file, overrides);
  return in_parallel(
      campaign.runs(), [&](std::size_t run) { return outcome_of(draw_run(campaign, run)); },
      static_cast<unsigned>(threads));
}

double quantile(std::vector<double> values, double share) {
  if (values.empty()) return std::nan("");
  const auto place = static_cast<std::size_t>(std::ceil(share * static_cast<double>(values.size())));
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(std::max<std::size_t>(place, 1) - 1);
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

}  // namespace flinch::test
