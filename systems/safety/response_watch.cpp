#include "systems/safety/response_watch.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace flinch {
namespace {

constexpr double pass = 0.3;       // of a low pass, a tick: most noise of second differences is gone
constexpr double reversed = -2.0;  // k - 1 of a torque of the wrong sign
constexpr double nearly = 0.2;     // by which it may be another one
constexpr double roughly = 0.4;    // by which that of a single part may be another one
constexpr int onset = 5;           // ticks that a drive takes to turn round; a contact grows
constexpr double evenly = 0.08;    // by which a part of the window may differ from all of it then
constexpr std::size_t part = 4;    // [ticks]
constexpr double missing = -1.0;   // k - 1 of a torque that is missing
constexpr double leftover = 0.15;  // by which it may be another one
constexpr double steady = 0.1;     // by which a part of the window may differ from all of it then
constexpr double along = 0.05;     // share of what is not explained that other causes may have
constexpr double energy = 0.4;     // of what takes the place of the torque, within the window and in all [J]
constexpr double felt = 0.5;       // of the least torque: what counts as one that is not explained
constexpr double memory = 0.5;     // of the energy that was taken [s]
constexpr double period = 1e-3;    // of readings [s]
constexpr double surely = 10.0;    // of a statistic over its limit, at most

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

/// The least of what must be true of a torque of the wrong sign, each over its limit. A drive turns round at
/// once and stays so; the force of what is pressed against its link grows, and its ratio to the torque with it.
double turned_round(const ResponseWatch& watch, Eigen::Index drive, double error) {
  if (watch.strange[drive] - watch.turned[drive] > onset) return 0.0;
  return std::min(over(std::abs(error - reversed), nearly), over(unevenness(watch, drive), evenly));
}

/// Likewise of a torque of which little is left, whatever it is that drives the robot in its place.
double driven_otherwise(const ResponseWatch& watch, Eigen::Index drive, double error) {
  double given = 0.0;
  for (const ResponseWatch::Tick& tick : watch.ticks) given += tick.given[drive] * period;
  return std::min({over(std::abs(error - missing), leftover), over(unevenness(watch, drive), steady),
                   given / energy, watch.net[drive] / energy});
}

/// By how surely the torque of a drive does something else; above 1: it does.
double judge(const ResponseWatch& watch, Eigen::Index drive, double least_torque) {
  const Sums all = sum(watch, drive, 0, ResponseWatch::window);
  const double error = all.gain_error();
  if (error > missing + leftover) return 0.0;
  double squares = 0.0, rest = 0.0;
  for (const ResponseWatch::Tick& tick : watch.ticks) {
    squares += tick.torque[drive] * tick.torque[drive];
    rest += tick.rest;
  }
  const double elsewhere = rest > 0.0 ? 1.0 - all.shared * all.shared / (all.own * rest) : 0.0;
  const double torque = std::sqrt(squares / static_cast<double>(ResponseWatch::window)) / least_torque;
  const double otherwise = std::max(turned_round(watch, drive, error), driven_otherwise(watch, drive, error));
  return std::min({torque, over(elsewhere, along), otherwise});
}

/// Takes in what the torque of a drive, with its column a_i of the mobility, did in this tick.
void take_in(ResponseWatch& watch, Eigen::Index drive, const JointVector& a_i, double rate, double interval,
             double least_torque) {
  ResponseWatch::Tick& now = watch.ticks[(watch.count - 1) % ResponseWatch::window];
  const double torque = watch.torque[drive];
  const double share = a_i.dot(watch.unexplained.head(a_i.size()));
  now.own[drive] = a_i.squaredNorm() * torque * torque;
  now.shared[drive] = torque * share;
  now.given[drive] = -torque * rate;
  const double strange = share / a_i.squaredNorm();  // a torque that would explain it [Nm or N]
  const double power = std::abs(strange) > felt * least_torque ? strange * rate : 0.0;
  watch.net[drive] += interval * (power - watch.net[drive] / memory);
  const bool alike = std::abs(sum(watch, drive, 0, part).gain_error() - reversed) < roughly;
  watch.strange[drive] = std::abs(strange) > least_torque ? watch.strange[drive] + 1 : 0;
  watch.turned[drive] = alike && watch.strange[drive] > 0 ? watch.turned[drive] + 1 : 0;
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
  ResponseWatch::Tick& now = watch.ticks[watch.count++ % ResponseWatch::window];
  now = {.torque = watch.torque, .rest = watch.unexplained.squaredNorm()};
  const PlatformMatrix a = mobility(tick);
  for (Eigen::Index i = 0; i < drives; ++i)
    take_in(watch, i, a.col(i), rates[i], interval, tick.limits.still_torque);
  if (watch.count < ResponseWatch::window) return;
  for (Eigen::Index i = 0; i < drives; ++i)
    note(found, PlausibilityCheck::response, judge(watch, i, tick.limits.still_torque),
         GateFault::torque_contradicted, static_cast<int>(i));
}

}  // namespace flinch
