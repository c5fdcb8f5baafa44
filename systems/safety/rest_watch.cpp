#include "systems/safety/rest_watch.h"

#include <algorithm>
#include <cmath>

#include "systems/safety/fault_table.h"

namespace flinch {
namespace {

constexpr Time brakes_close = 60ms;  // brakes of 30 ms, and as long again until the robot rests
constexpr Time torque_turns = 15ms;  // from one end of the range to the other, behind the velocity filter
constexpr double energy_left = 0.9;  // share of what it was 6 ms before; damping leaves two thirds

/// 1/2 v^T M_x v with the rates of the last two ticks [J].
double kinetic_energy(const PlausibilityTick& tick, const JointVector& rates) {
  const PlatformVector velocity = tick.kinematics.J_x_qa * rates;
  return 0.5 * velocity.dot(tick.dynamics.M_x * velocity);
}

/// From rates that the fault of the stop has not called in doubt: those that do are no controlled stop.
void judge_stop(RestWatch& watch, const PlausibilityTick& tick, const JointVector& rates,
                Plausibility& found) {
  const bool stops = watch.gate.phase == GatePhase::closed &&
                     watch.gate.reaction == GateReaction::controlled_stop && tick.kinematics.valid &&
                     tick.dynamics.valid && rates.size() > 0;
  if (!stops) {
    watch.energies = 0;
    watch.rested = false;
    return;
  }
  const double energy = kinetic_energy(tick, rates);
  const std::size_t ring = watch.energy.size();
  const double before = watch.energy[watch.energies % ring];
  const bool asked = watch.energies >= ring && tick.now - watch.gate.since > torque_turns && !watch.rested;
  watch.energy[watch.energies++ % ring] = energy;
  if (rates.lpNorm<Eigen::Infinity>() < 2.0 * tick.limits.resting_rate) watch.rested = true;
  if (asked && !watch.rested)
    note(found, PlausibilityCheck::stop, energy / (energy_left * before), GateFault::stop_ineffective);
}

void judge_brakes(RestWatch& watch, const PlausibilityTick& tick, const JointVector& rates,
                  Plausibility& found) {
  const bool should_hold = watch.engage && tick.now - watch.engaged > brakes_close;
  const bool in_doubt = (watch.gate.faults & faults_that_doubt(Doubt::angles)) != 0;
  if (!should_hold || in_doubt || rates.size() == 0) return;
  Eigen::Index drive = 0;
  const double fastest = rates.cwiseAbs().maxCoeff(&drive);
  note(found, PlausibilityCheck::brakes, fastest / tick.limits.resting_rate, GateFault::brake_not_holding,
       static_cast<int>(drive));
}

/// Brakes that have stayed closed, or drives whose torques end nowhere: a torque has been another one for
/// half the window, and nothing has moved in all of it.
void judge_still(RestWatch& watch, const AngleWatch& angles, const PlausibilityTick& tick,
                 Plausibility& found) {
  const std::size_t ring = watch.angle.size();
  const bool follows = tick.free && tick.limits.commands_act && watch.gate.passes() && angles.readings > 0;
  if (!follows || watch.torque[watch.ticks % ring].size() != tick.robot.drives()) {
    watch.ticks = 0;
    return;
  }
  watch.angle[watch.ticks % ring] = angles.angle.back();
  ++watch.ticks;
  if (watch.ticks < ring) return;
  double change = 0.0;
  for (Eigen::Index i = 0; i < tick.robot.drives(); ++i) {
    const double still = std::max(0.1 * tick.limits.resting_rate * 1e-3 * static_cast<double>(ring),
                                  10.0 * angles.angle_noise(i, tick.limits));
    double low = HUGE_VAL, high = -HUGE_VAL, least = HUGE_VAL;
    for (std::size_t age = 0; age < ring; ++age) {
      const std::size_t k = (watch.ticks + age) % ring;  // the oldest first
      if (watch.torque[k].size() <= i) return;
      low = std::min(low, watch.angle[k][i]);
      high = std::max(high, watch.angle[k][i]);
      const double since = std::abs(watch.torque[k][i] - watch.torque[watch.ticks % ring][i]);
      if (age >= ring / 2) least = std::min(least, since);
    }
    if (high - low > still) return;
    change = std::max(change, least);
  }
  note(found, PlausibilityCheck::still, change / tick.limits.still_torque, GateFault::drives_without_effect);
}

}  // namespace

void advance(RestWatch& watch, const AngleWatch& angles, const PlausibilityTick& tick,
             Plausibility& found) noexcept {
  const JointVector rates = tick.joints.valid ? angles.rates() : JointVector();
  judge_stop(watch, tick, rates, found);
  judge_brakes(watch, tick, rates, found);
  judge_still(watch, angles, tick, found);
}

void remember(RestWatch& watch, Time now, const GateStatus& gate, bool engage,
              const TorqueCommand& torque) noexcept {
  if (engage != watch.engage) watch.engaged = now;
  watch.engage = engage;
  watch.gate = gate;
  watch.torque[watch.ticks % watch.torque.size()] = torque.valid ? torque.torque : JointVector();
}

}  // namespace flinch
