#include "systems/motion/constraint_monitor.h"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "systems/foundation/findings.h"
#include "systems/foundation/setup_error.h"

namespace flinch {
namespace {

using Glide = ConstraintMonitor::Glide;

// [SafePR] Alg. 3
ConstraintMode mode_of(bool sigma_kappa, bool sigma_sc) {
  if (sigma_kappa && sigma_sc) return ConstraintMode::condition_number_and_self_collision;
  if (sigma_kappa) return ConstraintMode::condition_number;
  return sigma_sc ? ConstraintMode::self_collision : ConstraintMode::none;
}

bool is_inside(const ConstraintLimit& limit, double bound, double sigma) {
  return limit.safety > limit.activation ? sigma < bound : sigma > bound;
}

/// One measure at one tick.
void follow(Time now, const ConstraintLimit& limit, Time dwell, const ReactionState& state, const Task& task,
            double rate, Glide& glide) {
  const double sigma = task.sigma[0];
  const bool inside = is_inside(limit, limit.activation, sigma);  // [SafePR] Alg. 4
  if (!inside) glide.outside = now;
  const bool was_active = glide.active, holds = state.mode == ReactionMode::hold;
  glide.active = was_active ? holds || now - glide.outside < dwell : !inside;
  const bool stays = holds && is_inside(limit, limit.safety, sigma);
  const bool begins = !was_active || (stays && state.entered(ReactionMode::hold, now));
  const bool goes_on = was_active && state.entered(ReactionMode::react, now);
  if (!glide.active || !(begins || goes_on)) return;
  const double velocity = stays ? 0.0 : std::clamp(rate, -limit.glide.velocity, limit.glide.velocity);
  const ScalarMotion reference = goes_on ? glide.profile.evaluate(to_seconds(now - glide.begin))
                                         : ScalarMotion{sigma, velocity, 0.0, 0.0};
  glide.begin = now;
  glide.profile = JerkLimitedProfile::plan(reference, stays ? sigma : limit.safety, limit.glide);
}

TaskGoal goal_of(Time now, const Task& task, const ConstraintLimit& limit, const Glide& glide) {
  const ScalarMotion wanted = glide.profile.evaluate(to_seconds(now - glide.begin));
  const auto entry = [](double value) -> PlatformVector { return PlatformVector::Constant(1, value); };
  TaskGoal goal{task, {}, limit.gains};
  goal.reference = {entry(wanted.position - task.sigma[0]), entry(wanted.velocity),
                    entry(wanted.acceleration)};
  return goal;
}

ConstraintMeasure told(Time now, const Task& task, double rate, const ConstraintLimit& limit,
                       const Glide& glide) {
  const double reference =
      glide.active ? glide.profile.evaluate(to_seconds(now - glide.begin)).position : limit.activation;
  return {.active = glide.active,
          .sigma = task.sigma[0],
          .rate = rate,
          .reference = reference,
          .limit = limit.safety};
}

}  // namespace

std::vector<std::string> problems(const ConstraintSettings& settings) {
  Findings found("constraints: ");
  found.require(
      settings.sigma_kappa.activation >= 1.0 && settings.sigma_kappa.safety > settings.sigma_kappa.activation,
      "the safety value of the condition number must be above its activation value, and that above 1");
  found.require(settings.sigma_sc.safety > 0.0 && settings.sigma_sc.activation > settings.sigma_sc.safety,
                "the safety value of the self-collision distance must be positive and below its activation "
                "value");
  found.require(
      can_be_planned_with(settings.sigma_kappa.glide) && can_be_planned_with(settings.sigma_sc.glide),
      "limits of the glide must be positive");
  found.require(settings.dwell >= Time::zero(), "dwell must not be negative");
  return found.take();
}

ConstraintMonitor::ConstraintMonitor(std::shared_ptr<const ParallelRobot> robot,
                                     const ConstraintSettings& settings, Role role)
    : robot_(std::move(robot)), settings_(settings), role_(role) {
  throw_if_any(problems(settings));
}

bool ConstraintMonitor::watches(const ReactionState& state) const {
  using enum ReactionMode;
  if (role_ == Role::nominal) {
    return settings_.kept == ConstraintsKept::always && state.mode == nominal;
  }
  return settings_.kept != ConstraintsKept::never && (state.mode == react || state.mode == hold);
}

void ConstraintMonitor::measure(const Kinematics& now, Measures& measures) const {
  NearbyPlaces nearby;
  evaluate_nearby(*robot_, now, nearby);
  measures.sigma_kappa = condition_number_task(*robot_, now, nearby);
  measures.sigma_sc = self_collision_task(*robot_, now, nearby);
  measures.kappa_rate = measures.sigma_kappa.valid ? measures.sigma_kappa.rate(now.velocity)[0] : 0.0;
  measures.sc_rate = measures.sigma_sc.valid ? measures.sigma_sc.rate(now.velocity)[0] : 0.0;
}

void ConstraintMonitor::advance(Time now, const Memory& last, const ReactionState& state,
                                const Measures& measures, Memory& next) const {
  next = last;
  const bool watching = watches(state);
  const auto keep_within = [&](const ConstraintLimit& limit, const Task& task, double rate, Glide& glide) {
    if (watching && task.valid) {
      follow(now, limit, settings_.dwell, state, task, rate, glide);
    } else {
      glide.active = false;
    }
  };
  keep_within(settings_.sigma_kappa, measures.sigma_kappa, measures.kappa_rate, next.sigma_kappa);
  keep_within(settings_.sigma_sc, measures.sigma_sc, measures.sc_rate, next.sigma_sc);
  next.mode = mode_of(next.sigma_kappa.active, next.sigma_sc.active);
  if (next.mode != last.mode) next.since = now;
}

ConstraintState ConstraintMonitor::tell(Time now, const ReactionState& state, const Measures& measures,
                                        const Memory& memory) const {
  return {.valid = measures.sigma_kappa.valid && measures.sigma_sc.valid,
          .watched = watches(state),
          .mode = memory.mode,
          .sigma_kappa =
              told(now, measures.sigma_kappa, measures.kappa_rate, settings_.sigma_kappa, memory.sigma_kappa),
          .sigma_sc = told(now, measures.sigma_sc, measures.sc_rate, settings_.sigma_sc, memory.sigma_sc),
          .since = memory.since};
}

void ConstraintMonitor::lead(Time now, const Measures& measures, const Memory& memory, TaskList& list) const {
  list.count = 0;
  list.valid = true;
  list.add(goal_of(now, measures.sigma_kappa, settings_.sigma_kappa, memory.sigma_kappa));
  list.add(goal_of(now, measures.sigma_sc, settings_.sigma_sc, memory.sigma_sc));
}

}  // namespace flinch
