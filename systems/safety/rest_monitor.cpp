#include "systems/safety/rest_monitor.h"

#include <algorithm>
#include <cmath>

#include "systems/safety/fault_table.h"

namespace flinch {
namespace {

using Driven = Series<DrivenTick, 32>;
constexpr Time brakes_close = 60ms;  // brakes of 30 ms, and as long again until the robot rests
constexpr Time torque_turns = 15ms;  // from one end of the range to the other, behind the velocity filter
constexpr double idle_share =
    0.75;                         // of a change of torque; lags and friction leave half of it without effect
constexpr double surely = 5.0;    // standard deviations
constexpr Time drift_lasts = 1s;  // longer than any stop takes
constexpr Time rest_lasts = 100ms;  // a drift that turns seems to rest for less
constexpr double led_share = 0.3;   // of the power of gravity, were each drive to move with it
constexpr double guided = 0.25;     // speed at which a hand may lead a stopped robot [m/s], ISO 10218-1
constexpr Time longest_blind = 10ms;
constexpr double energy_left = 0.9;  // share of what it was 6 ms before; damping leaves two thirds

/// 1/2 v^T M_x v with the rates of the last two ticks [J].
double kinetic_energy(const PlausibilityTick& tick, const JointVector& rates) {
  const PlatformVector velocity = tick.kinematics.J_x_qa * rates;
  return 0.5 * velocity.dot(tick.dynamics.M_x * velocity);
}

/// What the model does not know of gravity, as of a payload, leads a robot that is only damped up or down,
/// for as long as it lasts. A hand may lead it across gravity; in a horizontal plane that is everywhere.
void judge_drift(RestMonitor& watch, const PlausibilityTick& tick, Plausibility& found) {
  const double resting = 0.5 * tick.limits.resting_rate;
  const JointVector g_qa = tick.kinematics.J_x_qa.transpose() * tick.dynamics.g_x;
  const double power = std::abs(g_qa.dot(tick.kinematics.rates.active));
  const double moves = tick.kinematics.rates.active.lpNorm<Eigen::Infinity>() / resting;
  const bool led = moves > 1.0 && power > led_share * resting * g_qa.lpNorm<1>();
  watch.unled = led ? 0 : watch.unled + 1;
  if (watch.unled >= tick.looks(rest_lasts)) watch.unled_at = tick.now;
  if (led && tick.now - std::max(watch.gate.since, watch.unled_at) > drift_lasts)
    note(found, PlausibilityCheck::stop, moves, GateFault::stop_ineffective);
}

bool stops(const GateStatus& gate) {
  return gate.phase == GatePhase::closed && gate.reaction == GateReaction::controlled_stop;
}

/// From rates that the fault of the stop has not called in doubt: those that do are no controlled stop. Asked
/// until the brakes are closed: a robot that has come to rest may be driven again.
void judge_stop(RestMonitor& watch, const PlausibilityTick& tick, const JointVector& rates,
                Plausibility& found) {
  const bool known = tick.kinematics.valid && tick.dynamics.valid && rates.size() > 0;
  if (!stops(watch.gate) || known) watch.blind = tick.now;
  if (!stops(watch.gate)) {
    watch.energies = 0;
    watch.unled = 0;
    return;
  }
  if (!known) {
    watch.energies = 0;
    const double blind = to_seconds(tick.now - watch.blind) / to_seconds(longest_blind);
    note(found, PlausibilityCheck::stop, blind, GateFault::stop_ineffective);
    return;
  }
  judge_drift(watch, tick, found);
  const double energy = kinetic_energy(tick, rates);
  const auto ring = static_cast<std::size_t>(tick.looks(6ms, 2));
  const double before = watch.energy[watch.energies % ring];
  const bool asked = watch.energies >= ring && tick.now - watch.gate.since > torque_turns;
  watch.energy[watch.energies++ % ring] = energy;
  if (asked && energy > 0.5 * tick.dynamics.M_x(0, 0) * guided * guided)
    note(found, PlausibilityCheck::stop, energy / (energy_left * before), GateFault::stop_ineffective);
}

void judge_brakes(RestMonitor& watch, const PlausibilityTick& tick, const JointVector& rates,
                  Plausibility& found) {
  const bool should_hold = watch.engage && tick.now - watch.engaged > brakes_close;
  const bool in_doubt = (watch.gate.faults & faults_that_doubt(Doubt::angles)) != 0;
  if (!should_hold || in_doubt || rates.size() == 0) return;
  Eigen::Index drive = 0;
  const double fastest = rates.cwiseAbs().maxCoeff(&drive);
  note(found, PlausibilityCheck::brakes, fastest / tick.limits.resting_rate, GateFault::brake_not_holding,
       static_cast<int>(drive));
}

/// The looks of the last 32 ms.
class StillWindow {
 public:
  StillWindow(const Driven& driven, const PlausibilityTick& tick)
      : driven_(driven),
        size(static_cast<std::size_t>(tick.looks(32ms))),
        arm(static_cast<std::size_t>(tick.looks(6ms))),
        T(tick.T()) {}

  bool is_full() const { return driven_.held() >= size; }
  /// What is `age` looks younger than the oldest.
  const DrivenTick& aged(std::size_t age) const { return driven_.back(size - 1 - age); }

 private:
  const Driven& driven_;

 public:
  const std::size_t size;
  const std::size_t arm;  ///< of a second difference
  const double T;         ///< from look to look [s]
};

bool drives_have_stood(const StillWindow& driven, const AngleMonitor& angles, const PlausibilityTick& tick) {
  for (Eigen::Index i = 0; i < tick.robot.drives(); ++i) {
    const double still =
        std::max(0.1 * tick.limits.resting_rate * driven.T * static_cast<double>(driven.size),
                 10.0 * angles.angle_noise(i, tick));
    double low = HUGE_VAL, high = -HUGE_VAL;
    for (std::size_t age = driven.size; age-- > 0;) {
      const double angle = driven.aged(age).angle[i];
      low = std::min(low, angle);
      high = std::max(high, angle);
      if (high - low > still) return false;
    }
  }
  return true;
}

/// By how much each torque has been another one for half the window than when it began [Nm].
Padded<max_dof> change_of_torque(const StillWindow& driven) {
  const Padded<max_dof>& oldest = driven.aged(0).torque;
  Padded<max_dof> least = Padded<max_dof>::Constant(HUGE_VAL);
  for (std::size_t age = driven.size / 2; age < driven.size; ++age)
    least = least.cwiseMin((driven.aged(age).torque - oldest).cwiseAbs());
  return least;
}

/// Acceleration of the drives around an age, and the torque that made it: both weighted as the second
/// difference of the angles over an arm weighs them.
struct DrivenMotion {
  Padded<max_dof> acceleration, torque;
};

DrivenMotion driven_motion(const StillWindow& driven, std::size_t age) {
  const std::size_t arm = driven.arm;
  const auto angle = [&](std::size_t at) -> const Padded<max_dof>& { return driven.aged(at).angle; };
  const auto area = static_cast<double>(arm * arm);
  DrivenMotion motion;
  motion.acceleration =
      (angle(age + arm) - 2.0 * angle(age) + angle(age - arm)) / (area * driven.T * driven.T);
  motion.torque.setZero();
  for (std::size_t away = 0; away < arm; ++away) {
    const double weight = static_cast<double>(arm - away) / area;
    motion.torque += weight * driven.aged(age + away).torque;
    if (away > 0) motion.torque += weight * driven.aged(age - away).torque;
  }
  return motion;
}

/// How surely the change of each torque, from the begin of the window to its end, has moved nothing: what
/// M_qa ddq leaves of it, over what honest drives leave; above 1 for those that do not move the robot.
/// Gravity, bias and all that lasts is in both ends.
JointVector idleness(const StillWindow& driven, const AngleMonitor& angles, const PlausibilityTick& tick) {
  const DrivenMotion first = driven_motion(driven, driven.arm);
  const DrivenMotion last = driven_motion(driven, driven.size - 1 - driven.arm);
  const PlatformMatrix& J = tick.kinematics.J_x_qa;
  const PlatformMatrix M_qa = J.transpose() * tick.dynamics.M_x * J;
  const Eigen::Index drives = M_qa.rows();
  const JointVector change = (last.torque - first.torque).head(drives);
  const JointVector idle = change - M_qa * (last.acceleration - first.acceleration).head(drives);
  JointVector noise(idle.size());  // of that difference of accelerations
  const auto area = static_cast<double>(driven.arm * driven.arm);
  for (Eigen::Index i = 0; i < noise.size(); ++i)
    noise[i] = std::sqrt(12.0) * angles.angle_noise(i, tick) / (area * driven.T * driven.T);
  const JointVector unsure = surely * (M_qa.cwiseAbs() * noise);
  return idle.cwiseAbs().cwiseQuotient((idle_share * change.cwiseAbs()).cwiseMax(unsure));
}

/// Brakes that have stayed closed, or drives whose torques end nowhere: a torque has been another one for
/// half the window, nothing has moved to speak of, and not as this torque would move it. An honest robot
/// that comes to rest moves as little, but as its torque says.
void judge_still(RestMonitor& watch, const RestMonitor::Driven::Past& past, const AngleMonitor& angles,
                 const PlausibilityTick& tick, Plausibility& found) {
  const bool follows = tick.free && tick.limits.commands_act && watch.gate.passes() && angles.readings > 0;
  if (!follows || watch.torque.size() != tick.robot.drives()) {
    watch.driven.clear();
    return;
  }
  watch.driven.push({padded(angles.angle.back()), padded(watch.torque)});
  const Driven ring(watch.driven, past);
  const StillWindow driven(ring, tick);
  const bool known = driven.is_full() && tick.kinematics.valid && tick.dynamics.valid;
  if (!known || !drives_have_stood(driven, angles, tick)) return;
  const JointVector changed = change_of_torque(driven).head(tick.robot.drives()) / tick.limits.still_torque;
  note(found, PlausibilityCheck::still, changed.cwiseMin(idleness(driven, angles, tick)).maxCoeff(),
       GateFault::drives_without_effect);
}

}  // namespace

void advance(RestMonitor& watch, const RestMonitor::Driven::Past& past, const AngleMonitor& angles,
             const PlausibilityTick& tick, Plausibility& found) noexcept {
  const JointVector rates = tick.joints.valid ? angles.rates() : JointVector();
  judge_stop(watch, tick, rates, found);
  judge_brakes(watch, tick, rates, found);
  judge_still(watch, past, angles, tick, found);
}

void remember(RestMonitor& watch, Time now, const GateStatus& gate, bool engage,
              const TorqueCommand& torque) noexcept {
  if (engage != watch.engage) watch.engaged = now;
  watch.engage = engage;
  watch.gate = gate;
  watch.torque = torque.valid ? torque.torque : JointVector();
}

}  // namespace flinch
