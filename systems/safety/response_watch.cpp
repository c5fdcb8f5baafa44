#include "systems/safety/response_watch.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace flinch {
namespace {

constexpr double pass = 0.3;        // of a low pass, a tick: most noise of second differences is gone
constexpr double reversed = -2.0;   // k - 1 of a torque of the wrong sign
constexpr double nearly = 0.2;      // by which it may be another one
constexpr double roughly = 0.4;     // by which that of a single part may be another one
constexpr int onset = 5;            // ticks that a drive takes to turn round; a contact grows
constexpr double evenly = 0.08;     // by which a part of the window may differ from all of it then
constexpr std::size_t part = 4;     // [ticks]
constexpr double missing = -1.0;    // k - 1 of a torque that is missing
constexpr double hardly = 0.08;     // by which it may be another one
constexpr double backward = -1.45;  // k - 1 from which on a torque has the wrong sign, whatever else acts
constexpr double steady = 0.1;      // by which a part of the window may differ from all of it then
constexpr double along = 0.05;      // share of what is not explained that other causes may have then
constexpr double energy = 0.4;      // of what takes the place of the torque, within the window and in all [J]
constexpr double memory = 0.5;      // of the energy that was taken [s]
constexpr double period = 1e-3;     // of readings [s]
constexpr double surely = 10.0;     // of a statistic over its limit, at most

/// What 1 Nm of each drive makes of the drives' accelerations: J_qa,x M_x^-1 J_qa,x^T.
PlatformMatrix mobility(const PlausibilityTick& tick) {
  const auto& J = tick.kinematics.J_qa_x;
  return J * tick.dynamics.M_x.llt().solve(J.transpose());
}

struct Sums {
  double own = 0.0, shared = 0.0;
  double gain_error() const { return own > 0.0 ? shared / own : 0.0; }
};

Sums sum(const ResponseWatch& watch, Eigen::Index drive, std::size_t from, std::size_t to) {
  Sums sums;
  for (std::size_t age = from; age < to; ++age) {
    const auto& tick = watch.ticks[(watch.count - 1 - age) % ResponseWatch::window];
    sums.own += tick.own[drive];
    sums.shared += tick.shared[drive];
  }
  return sums;
}

/// By how much the gain of a part of the window differs from that of all of it, at most; a share of it.
double unevenness(const ResponseWatch& watch, Eigen::Index drive) {
  constexpr std::size_t n = ResponseWatch::window;
  const double error = sum(watch, drive, 0, n).gain_error();
  double most = 0.0;
  for (std::size_t from = 0; from < n; from += part)
    most = std::max(most, std::abs(sum(watch, drive, from, from + part).gain_error() - error));
  return most / std::abs(error);
}

double over(double value, double limit) { return value < limit / surely ? surely : limit / value; }

/// What is not explained besides what the torque of a drive leaves; a share of its square.
double elsewhere(const ResponseWatch& watch, const Sums& all) {
  double rest = 0.0;
  for (const ResponseWatch::Tick& tick : watch.ticks) rest += tick.rest;
  return rest > 0.0 ? 1.0 - all.shared * all.shared / (all.own * rest) : 0.0;
}

/// The least of what must be true of a torque of the wrong sign, each over its limit. A drive turns round at
/// once and stays so; the force of what is pressed against its link grows, and its ratio to the torque with it.
double turned_round(const ResponseWatch& watch, Eigen::Index drive, const Sums& all) {
  if (watch.strange[drive] - watch.turned[drive] > onset) return 0.0;
  return std::min({over(std::abs(all.gain_error() - reversed), nearly),
                   over(unevenness(watch, drive), evenly), over(elsewhere(watch, all), along)});
}

/// Likewise of a drive that is moved against its torque, at every instant alike, by what gives more energy than
/// it ever took. No thing that the robot runs into does the one, and nothing that runs into it the other.
double driven_otherwise(const ResponseWatch& watch, Eigen::Index drive, double error) {
  double given = 0.0;
  for (const ResponseWatch::Tick& tick : watch.ticks) given += tick.given[drive] * period;
  const double like = std::max(error / backward, over(std::abs(error - missing), hardly));
  return std::min({like, given / energy, watch.net / energy, over(unevenness(watch, drive), steady)});
}

/// How surely the torque of a drive does something else; above 1: it does.
double judge(const ResponseWatch& watch, Eigen::Index drive, double least_torque) {
  const Sums all = sum(watch, drive, 0, ResponseWatch::window);
  if (all.gain_error() > missing + hardly) return 0.0;
  double squares = 0.0;
  for (const ResponseWatch::Tick& tick : watch.ticks) squares += tick.torque[drive] * tick.torque[drive];
  const double torque = std::sqrt(squares / static_cast<double>(ResponseWatch::window)) / least_torque;
  return std::min(
      torque, std::max(turned_round(watch, drive, all), driven_otherwise(watch, drive, all.gain_error())));
}

/// Takes in what the torque of a drive, with its column a_i of the mobility, did in this tick.
void take_in(ResponseWatch& watch, Eigen::Index drive, const JointVector& a_i, double least_torque) {
  ResponseWatch::Tick& now = watch.ticks[(watch.count - 1) % ResponseWatch::window];
  const double torque = watch.torque[drive];
  const double share = a_i.dot(watch.unexplained.head(a_i.size()));
  now.own[drive] = a_i.squaredNorm() * torque * torque;
  now.shared[drive] = torque * share;
  now.given[drive] = -torque * watch.rates[drive];
  const bool strange = std::abs(share) > least_torque * a_i.squaredNorm();
  const bool alike = std::abs(sum(watch, drive, 0, part).gain_error() - reversed) < roughly;
  watch.strange[drive] = strange ? watch.strange[drive] + 1 : 0;
  watch.turned[drive] = strange && alike ? watch.turned[drive] + 1 : 0;
}

/// Energy that what is not explained gave the robot since the reading before; 0 where it may be friction or
/// mass that differ [J]. Drives lag behind their commands, so the power of their torques is as measured.
double strange_energy(const ResponseWatch& watch, const JointVector& unexplained, double interval,
                      const JointVector& torque, const JointVector& rates, const PlausibilityTick& tick) {
  const PlatformMatrix& J = tick.kinematics.J_x_qa;
  const auto wrench = [&](const auto& accelerations) -> PlatformVector {
    return tick.dynamics.M_x * (J * accelerations);
  };
  const PlatformVector felt = wrench(watch.unexplained.head(J.cols()));
  if ((J.transpose() * felt).lpNorm<Eigen::Infinity>() < 0.5 * tick.limits.still_torque) return 0.0;
  const JointVector lag = watch.measured.head(J.cols()) - torque;
  return wrench(unexplained).dot(J * rates) - interval * lag.dot(rates);
}

}  // namespace

void advance(ResponseWatch& watch, const JointVector& unexplained, double interval, const JointVector& torque,
             const JointVector& rates, const PlausibilityTick& tick, Plausibility& found) noexcept {
  const Eigen::Index drives = tick.robot.drives();
  const bool known = tick.free && unexplained.size() == drives && torque.size() == drives &&
                     rates.size() == drives && interval > 0.0;
  if (!known) {
    if (watch.count > 0) watch = ResponseWatch();
    return;
  }
  watch.unexplained += pass * (padded(unexplained) / interval - watch.unexplained);
  watch.torque += pass * (padded(torque) - watch.torque);
  watch.rates += pass * (padded(rates) - watch.rates);
  const bool measured = tick.torque.valid && tick.torque.torque.size() == drives;
  if (watch.count == 0) watch.measured = padded(measured ? tick.torque.torque : torque);
  watch.net +=
      strange_energy(watch, unexplained, interval, torque, rates, tick) - interval / memory * watch.net;
  watch.measured = padded(measured ? tick.torque.torque : torque);
  ResponseWatch::Tick& now = watch.ticks[watch.count++ % ResponseWatch::window];
  now = {.torque = watch.torque, .rest = watch.unexplained.squaredNorm()};
  const PlatformMatrix a = mobility(tick);
  for (Eigen::Index i = 0; i < drives; ++i) take_in(watch, i, a.col(i), tick.limits.still_torque);
  if (watch.count < ResponseWatch::window) return;
  for (Eigen::Index i = 0; i < drives; ++i)
    note(found, PlausibilityCheck::response, judge(watch, i, tick.limits.still_torque),
         GateFault::torque_contradicted, static_cast<int>(i));
}

}  // namespace flinch
