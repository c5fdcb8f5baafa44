#include "systems/safety/response_watch.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace flinch {
namespace {

constexpr double pass = 0.3;       // of a low pass, a tick: most noise of second differences is gone
constexpr double reversed = -2.0;  // k - 1 of a torque of the wrong sign
constexpr double nearly = 0.3;     // by which it may be another one
constexpr double evenly = 0.06;    // by which the halves of the window may differ then
constexpr double missing = -0.75;  // k - 1 from which on little of a torque is left
constexpr double steady = 0.15;    // by which the halves of the window may differ then
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

double over(double value, double limit) { return value < limit / surely ? surely : limit / value; }

/// The least of all that must be true of a drive whose torque does something else, each over its limit.
double judge(const ResponseWatch& watch, Eigen::Index drive, double least_torque) {
  constexpr std::size_t n = ResponseWatch::window;
  const Sums all = sum(watch, drive, 0, n);
  const double error = all.gain_error();
  if (error > missing) return 0.0;
  double squares = 0.0, rest = 0.0, given = 0.0;
  for (const ResponseWatch::Tick& tick : watch.ticks) {
    squares += tick.torque[drive] * tick.torque[drive];
    rest += tick.rest;
    given += tick.given[drive] * period;
  }
  const double elsewhere = rest > 0.0 ? 1.0 - all.shared * all.shared / (all.own * rest) : 0.0;
  const double young = sum(watch, drive, 0, n / 2).gain_error();
  const double old = sum(watch, drive, n / 2, n).gain_error();
  const double uneven = std::max(std::abs(young - error), std::abs(old - error)) / std::abs(error);
  const double turned = std::min(over(std::abs(error - reversed), nearly), over(uneven, evenly));
  const double driven = std::min({given / energy, watch.net[drive] / energy, over(uneven, steady)});
  const double torque = std::sqrt(squares / n) / least_torque;
  return std::min({torque, over(elsewhere, along), std::max(turned, driven)});
}

}  // namespace

void advance(ResponseWatch& watch, const JointVector& unexplained, double interval, const JointVector& torque,
             const JointVector& rates, const PlausibilityTick& tick, Plausibility& found) noexcept {
  const Eigen::Index drives = tick.robot.drives();
  const bool known = tick.free && unexplained.size() == drives && torque.size() == drives &&
                     rates.size() == drives && interval > 0.0;
  if (!known) {
    watch.count = 0;
    watch.unexplained.setZero();
    watch.torque.setZero();
    watch.net.setZero();
    return;
  }
  watch.unexplained += pass * (padded(unexplained) / interval - watch.unexplained);
  watch.torque += pass * (padded(torque) - watch.torque);
  const PlatformMatrix a = mobility(tick);
  ResponseWatch::Tick& now = watch.ticks[watch.count++ % ResponseWatch::window];
  now = ResponseWatch::Tick();
  now.rest = watch.unexplained.squaredNorm();
  now.torque = watch.torque;
  for (Eigen::Index i = 0; i < drives; ++i) {
    now.own[i] = a.col(i).squaredNorm() * watch.torque[i] * watch.torque[i];
    now.shared[i] = watch.torque[i] * a.col(i).dot(watch.unexplained.head(drives));
    now.given[i] = -watch.torque[i] * rates[i];
    const double strange = a.col(i).dot(watch.unexplained.head(drives)) / a.col(i).squaredNorm();
    const double power = std::abs(strange) > felt * tick.limits.still_torque ? strange * rates[i] : 0.0;
    watch.net[i] += interval * (power - watch.net[i] / memory);
  }
  if (watch.count < ResponseWatch::window) return;
  for (Eigen::Index i = 0; i < drives; ++i)
    note(found, PlausibilityCheck::response, judge(watch, i, tick.limits.still_torque),
         GateFault::torque_contradicted, static_cast<int>(i));
}

}  // namespace flinch
