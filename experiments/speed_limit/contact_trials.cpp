#include "experiments/speed_limit/contact_trials.h"

#include <algorithm>
#include <optional>
#include <string>
#include <utility>

#include "experiments/campaign/drawn_contact.h"
#include "experiments/simulated/experiment.h"
#include "experiments/verdict/verdict.h"
#include "systems/config/config_node.h"
#include "systems/config/parsed.h"
#include "systems/config/yaml_text.h"
#include "systems/foundation/setup_error.h"

namespace flinch {
namespace {

constexpr double watched_after = 0.3;   // the transient duration of a contact [s]
constexpr double least_fraction = 0.9;  // of the speed that was asked for, at the onset

/// The run `drawn` with the platform at `speed` [m/s].
CampaignRun at_speed(const CampaignRun& drawn, const ConfigNode& root, double speed,
                     const Campaign& campaign) {
  CampaignRun run = drawn;
  const auto faster = with_value(root, "motion.speed_m_per_s", scalar_node(exact_text(speed)));
  run.scenario = parse_simulated_scenario(faster, drawn.scenario.file, *campaign.robots);
  if (campaign.addition) campaign.addition->add(run.scenario);
  const double contact = meeting_point_of(run.scenario).time +
                         to_seconds(run.scenario.control.trajectory.start.value_or(Time::zero()));
  const double duration = contact + run.scenario.force_limits.transient_duration + watched_after;
  run.scenario.duration = from_seconds(duration);
  run.values.emplace_back("duration_s", exact_text(duration));
  return run;
}

/// Largest force over its limit.
double used_fraction(const RunResult& result) {
  const double peak = result.peak_force.value_or(0.0) / result.transient_limit.value_or(1.0);
  const double lasting = result.lasting_force.value_or(0.0) / result.quasi_static_limit.value_or(1.0);
  return std::max(peak, lasting);
}

SpeedTrial ended(const RunResult& result, double speed) {
  if (result.over_limit > 0.0) return SpeedTrial::exceeded;
  const bool is_meant = result.body == result.meant;
  return is_meant && result.speed.value_or(0.0) >= least_fraction * speed ? SpeedTrial::within
                                                                          : SpeedTrial::untested;
}

}  // namespace

ContactTrials::ContactTrials(const Campaign& campaign, double slowest, std::size_t count)
    : campaign_(campaign), slowest_(slowest) {
  for (std::size_t number = 0; drawn_.size() < count; ++number) {
    if (number >= 2 * count) {
      throw SetupError("in " + std::to_string(number - drawn_.size()) + " of " + std::to_string(number) +
                       " contacts that were drawn the " + campaign.contact->bodies.front() +
                       " is not the first to touch the obstacle at the slowest speed; in " +
                       std::to_string(false_alarms_) + " a false alarm stopped the robot before");
    }
    Drawn drawn{draw_run(campaign, number), nullptr};
    drawn.root = parse_yaml(drawn.run.scenario.text, drawn.run.scenario.file.string());
    drawn.at_slowest = run_at(drawn, slowest);
    if (drawn.at_slowest.ended != SpeedTrial::untested) drawn_.push_back(std::move(drawn));
  }
}

TrialResult ContactTrials::operator()(std::size_t trial, double speed) {
  const Drawn& drawn = drawn_[trial];
  return speed == slowest_ ? drawn.at_slowest : run_at(drawn, speed);
}

const RunResult* ContactTrials::nearest(double speed) const {
  const auto found = nearest_.find(speed);
  return found == nearest_.end() ? nullptr : &found->second;
}

TrialResult ContactTrials::run_at(const Drawn& drawn, double speed) {
  std::optional<CampaignRun> run;
  try {
    run = at_speed(drawn.run, *drawn.root, speed, campaign_);
  } catch (const SetupError&) {  // the motion has no room for that speed, or begins in the obstacle
    return {};
  }
  RunResult result = result_of(*run, judge_experiment(run->scenario));
  const TrialResult trial{ended(result, speed), used_fraction(result)};
  const bool is_alarmed = !result.estimators.empty() && result.estimators.front().false_alarm;
  if (trial.ended == SpeedTrial::untested && is_alarmed) ++false_alarms_;
  if (trial.ended != SpeedTrial::within) return trial;
  const auto before = nearest_.find(speed);
  if (before == nearest_.end() || used_fraction(before->second) < trial.used)
    nearest_.insert_or_assign(speed, std::move(result));
  return trial;
}

}  // namespace flinch
