#include "systems/safety/response_monitor.h"

#include <algorithm>
#include <cmath>

namespace flinch {
namespace {

constexpr double pass = 0.3;       // of a low pass, a millisecond: most noise of second differences is gone
constexpr double reversed = -2.0;  // k - 1 of a torque of the wrong sign
constexpr double nearly = 0.2;     // by which it may be another one
constexpr double roughly = 0.4;    // by which that of a single part may be another one
constexpr Time onset = 5ms;        // in which a drive turns round; a contact grows
constexpr double evenly = 0.08;    // by which a part of the window may differ from all of it then
constexpr Time part_of_window = 4ms;
constexpr double opposed = -1.5;  // k - 1 from which on a torque has the wrong sign, whatever else acts
constexpr double missing = -1.0;  // k - 1 of a torque that is missing
constexpr double hardly = 0.05;   // by which it may be another one
constexpr double steady = 0.1;    // by which a part of the window may differ from all of it then
constexpr double along = 0.05;    // share of what is not explained that other causes may have then
constexpr double energy = 0.4;    // of what takes the place of the torque, within the window and in all [J]
constexpr double more_energy = 0.6;  // likewise, where a hand may do the same
constexpr double memory = 0.5;       // of the energy that was taken [s]
constexpr double surely = 10.0;      // of a statistic over its limit, at most

/// The share that the low pass lets through from look to look.
double share_of_look(const PlausibilityTick& tick) {
  return tick.period == 1ms ? pass : 1.0 - std::pow(1.0 - pass, tick.T() / 1e-3);
}

struct Sums {
  double own = 0.0, shared = 0.0;
  double gain_error() const { return own > 0.0 ? shared / own : 0.0; }
};

/// How many looks there are in the window and in a part of it.
struct WindowLooks {
  explicit WindowLooks(const PlausibilityTick& tick)
      : part(static_cast<std::size_t>(tick.looks(part_of_window))), window(ResponseMonitor::parts * part) {}
  std::size_t part, window;
};

Sums sum(const ResponseMonitor& watch, Eigen::Index drive, const WindowLooks& looks, std::size_t from,
         std::size_t to) {
  Sums sums;
  for (std::size_t age = from; age < to; ++age) {
    const auto& tick = watch.ticks[(watch.count - 1 - age) % looks.window];
    sums.own += tick.own[drive];
    sums.shared += tick.shared[drive];
  }
  return sums;
}

/// By how much the gain of a part of the window differs from that of all of it, at most; a share of it.
double unevenness(const ResponseMonitor& watch, Eigen::Index drive, const WindowLooks& looks, double error) {
  double most = 0.0;
  for (std::size_t from = 0; from < looks.window; from += looks.part)
    most = std::max(most, std::abs(sum(watch, drive, looks, from, from + looks.part).gain_error() - error));
  return most / std::abs(error);
}

double over(double value, double limit) { return value < limit / surely ? surely : limit / value; }

/// What the window tells of a drive.
struct Trace {
  double error;      ///< of its gain, k - 1
  double uneven;     ///< see unevenness()
  double elsewhere;  ///< what is not explained besides what its torque leaves; a share of its square
  double torque;     ///< root mean square [Nm or N]
  double given;      ///< what takes the place of its torque gave [J]
};

Trace trace_of(const ResponseMonitor& watch, Eigen::Index drive, const WindowLooks& looks, double T,
               const Sums& all) {
  double squares = 0.0, rest = 0.0, given = 0.0;
  for (std::size_t k = 0; k < looks.window; ++k) {
    const ResponseMonitor::Tick& tick = watch.ticks[k];
    squares += tick.torque[drive] * tick.torque[drive];
    rest += tick.foreign;
    given += tick.given[drive] * T;
  }
  return {.error = all.gain_error(),
          .uneven = unevenness(watch, drive, looks, all.gain_error()),
          .elsewhere = rest > 0.0 ? 1.0 - all.shared * all.shared / (all.own * rest) : 0.0,
          .torque = std::sqrt(squares / static_cast<double>(looks.window)),
          .given = given};
}

/// The least of what must be true of a torque of the wrong sign, each over its limit. A drive turns round at
/// once and stays so; the force of what is pressed against its link grows, with its ratio to the torque.
double turned_round(const ResponseMonitor& watch, std::size_t drive, int onset_looks, const Trace& is) {
  if (watch.strange[drive] - watch.turned[drive] > onset_looks) return 0.0;
  return std::min(
      {over(std::abs(is.error - reversed), nearly), over(is.uneven, evenly), over(is.elsewhere, along)});
}

/// Likewise of a drive that is moved against its torque, at every instant alike, by what gives more energy
/// than it ever took. No thing that the robot runs into does the one, nothing that runs into it the other.
double driven_otherwise(double net, const Trace& is) {
  const double gives = std::min(is.given, net);
  const double backward = std::min(is.error / opposed, gives / energy);
  const double missed =
      std::min({over(std::abs(is.error - missing), hardly), gives / more_energy, over(is.elsewhere, along)});
  return std::min(std::max(backward, missed), over(is.uneven, steady));
}

/// How surely the torque of a drive does something else; above 1: it does.
double judge(const ResponseMonitor& watch, Eigen::Index drive, const PlausibilityTick& tick) {
  const WindowLooks looks(tick);
  const Sums all = sum(watch, drive, looks, 0, looks.window);
  if (all.gain_error() > missing + hardly) return 0.0;
  const Trace is = trace_of(watch, drive, looks, tick.T(), all);
  const double turned = turned_round(watch, static_cast<std::size_t>(drive), tick.looks(onset), is);
  return std::min(is.torque / tick.limits.still_torque, std::max(turned, driven_otherwise(watch.net, is)));
}

/// Takes in what the torque of a drive did in this tick. `leaves`: what the lack of 1 Nm of it leaves at each
/// drive; of robots with no more drives than they need, at itself alone.
void take_in(ResponseMonitor& watch, Eigen::Index drive, const WindowLooks& looks, const JointVector& leaves,
             double least_torque) {
  ResponseMonitor::Tick& now = watch.ticks[(watch.count - 1) % looks.window];
  const double torque = watch.torque[drive];
  const double share = leaves.dot(watch.foreign.head(leaves.size()));
  now.own[drive] = leaves.squaredNorm() * torque * torque;
  now.shared[drive] = torque * share;
  now.given[drive] = -torque * watch.rates[drive];
  const bool strange = std::abs(share) > least_torque * leaves.squaredNorm();
  const bool alike =
      strange && std::abs(sum(watch, drive, looks, 0, looks.part).gain_error() - reversed) < roughly;
  const auto i = static_cast<std::size_t>(drive);
  watch.strange[i] = strange ? watch.strange[i] + 1 : 0;
  watch.turned[i] = alike ? watch.turned[i] + 1 : 0;
}

/// Energy that foreign torques gave the robot within an interval; 0 where they may be friction or mass that
/// differ [J]. Drives lag behind their commands, so the power of their own is as measured.
double foreign_energy(const ResponseMonitor& watch, const JointVector& foreign, double interval,
                      const JointVector& torque, const JointVector& rates, double least_torque) {
  if (watch.foreign.lpNorm<Eigen::Infinity>() < 0.5 * least_torque) return 0.0;
  const JointVector lag = watch.measured.head(rates.size()) - torque;
  return interval * (foreign - lag).dot(rates);
}

}  // namespace

void advance(ResponseMonitor& watch, const JointVector& unexplained, double interval,
             const JointVector& torque, const JointVector& rates, const PlausibilityTick& tick,
             Plausibility& found) noexcept {
  const Eigen::Index drives = tick.robot.drives();
  const bool known = tick.free && unexplained.size() == drives && torque.size() == drives &&
                     rates.size() == drives && interval > 0.0;
  if (!known) {
    if (watch.count > 0) watch = ResponseMonitor();
    return;
  }
  const double least_torque = tick.limits.still_torque;
  const PlatformMatrix& J = tick.kinematics.J_x_qa;
  const JointVector foreign = J.transpose() * (tick.dynamics.M_x * (J * unexplained / interval));
  const double share = share_of_look(tick);
  watch.foreign += share * (padded(foreign) - watch.foreign);
  watch.torque += share * (padded(torque) - watch.torque);
  watch.rates += share * (padded(rates) - watch.rates);
  const bool is_measured = tick.torque.valid && tick.torque.torque.size() == drives;
  const Padded<max_dof> measured = padded(is_measured ? tick.torque.torque : torque);
  if (watch.count == 0) watch.measured = measured;
  watch.net += foreign_energy(watch, foreign, interval, torque, rates, least_torque);
  watch.net -= interval / memory * watch.net;
  watch.measured = measured;
  const WindowLooks looks(tick);
  ResponseMonitor::Tick& now = watch.ticks[watch.count++ % looks.window];
  now = {.torque = watch.torque, .foreign = watch.foreign.squaredNorm()};
  const PlatformMatrix leaves = (tick.kinematics.J_qa_x * J).transpose();
  for (Eigen::Index i = 0; i < drives; ++i) take_in(watch, i, looks, leaves.col(i), least_torque);
  if (watch.count < looks.window) return;
  for (Eigen::Index i = 0; i < drives; ++i)
    note(found, PlausibilityCheck::response, judge(watch, i, tick), GateFault::torque_contradicted,
         static_cast<int>(i));
}

}  // namespace flinch
