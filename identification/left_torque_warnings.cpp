#include "identification/left_torque_warnings.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "identification/robust_mean.h"
#include "identification/root_mean_square.h"

namespace flinch {
namespace {

constexpr double moves = 0.1;             // of a drive's usual speed, from which on friction cannot hold it
constexpr std::size_t fewest_rows = 20;   // of a drive in half a second
constexpr std::size_t fewest_means = 16;  // that tell what is usual
constexpr double far = 10.0;              // deviations of the means, which no error of a model is
constexpr double rare = 0.3;              // of the means; more than that is no contact but another robot
constexpr double clear = 6.0;             // standard deviations of a drift
constexpr double worth_telling = 0.05;    // of a drive's torque: a drift
constexpr double shortest = 10.0;         // recording that tells a drift [s]
constexpr double cluster_length = 0.5;    // [s]

/// What is left of the torque of a drive over half a second in which it moves.
struct LeftMean {
  double time = 0.0;      ///< [s]
  double torque = 0.0;    ///< [Nm or N]
  double friction = 0.0;  ///< Torque along the motion [Nm or N].
};

/// Of one drive in one recording, in the order of time.
using LeftMeans = std::vector<LeftMean>;

/// Speed of the drive at each row [rad/s or m/s]; its sign is that of the motion.
Eigen::VectorXd speeds(const DynamicsRows& rows) {
  Eigen::VectorXd speed(static_cast<Eigen::Index>(rows.drive.size()));
  for (std::size_t row = 0; row < rows.drive.size(); ++row)
    speed[static_cast<Eigen::Index>(row)] =
        rows.paths[rows.path[row]].speed(rows.sample[row], rows.drive[row]);
  return speed;
}

/// By recording and drive.
std::map<std::pair<int, int>, LeftMeans> left_means(const DynamicsRows& rows, const Eigen::VectorXd& left) {
  const Eigen::VectorXd speed = speeds(rows);
  std::map<int, double> usual;
  for (const int drive : std::set<int>(rows.drive.begin(), rows.drive.end()))
    usual[drive] = root_mean_square(of_drive(rows, speed, drive));
  struct Sum {
    double torque = 0.0, friction = 0.0;
    std::size_t count = 0;
  };
  std::map<std::pair<int, int>, std::map<int, Sum>> sums;
  for (Eigen::Index row = 0; row < speed.size(); ++row) {
    const auto at = static_cast<std::size_t>(row);
    const int drive = rows.drive[at];
    if (std::abs(speed[row]) < moves * usual[drive]) continue;
    Sum& sum = sums[{rows.recording[at], drive}][static_cast<int>(rows.time[at] / cluster_length)];
    sum.torque += left[row];
    sum.friction += speed[row] > 0.0 ? left[row] : -left[row];
    ++sum.count;
  }
  std::map<std::pair<int, int>, LeftMeans> means;
  for (const auto& [of, clusters] : sums) {
    for (const auto& [cluster, sum] : clusters) {
      if (sum.count < fewest_rows) continue;
      const auto n = static_cast<double>(sum.count);
      means[of].push_back({cluster_length * cluster, sum.torque / n, sum.friction / n});
    }
  }
  return means;
}

/// A stretch of time in which some drives' torques are far from what is usual.
struct Touch {
  double from = 0.0;    ///< [s]
  double to = 0.0;      ///< [s]
  double torque = 0.0;  ///< largest mean [Nm or N]
  double usual = 0.0;   ///< deviation of that drive's means [Nm or N]
  int drive = 0;
};

void add(const Touch& touch, std::vector<Touch>& touches) {
  for (Touch& other : touches) {
    if (touch.from > other.to + 1e-9 || other.from > touch.to + 1e-9) continue;
    const double from = std::min(touch.from, other.from), to = std::max(touch.to, other.to);
    if (std::abs(touch.torque) * other.usual > std::abs(other.torque) * touch.usual) other = touch;
    other.from = from;
    other.to = to;
    return;
  }
  touches.push_back(touch);
}

/// A straight line through values over time.
struct Drift {
  double change = 0.0;     ///< from the first to the last
  double deviation = 0.0;  ///< of that
};

Drift drift_of(const LeftMeans& means, double LeftMean::*value) {
  const auto n = static_cast<double>(means.size());
  double st = 0.0, sx = 0.0;
  for (const LeftMean& mean : means) st += mean.time, sx += mean.*value;
  double tt = 0.0, tx = 0.0, rest = 0.0;
  for (const LeftMean& mean : means) {
    const double t = mean.time - st / n;
    tt += t * t;
    tx += t * (mean.*value - sx / n);
  }
  if (!(tt > 0.0)) return {};
  const double slope = tx / tt;
  for (const LeftMean& mean : means) rest += std::pow(mean.*value - sx / n - slope * (mean.time - st / n), 2);
  const double length = means.back().time - means.front().time;
  return {slope * length, length * std::sqrt(rest / (n - 2.0) / tt)};
}

}  // namespace

std::vector<std::string> warnings_about_contacts(const DynamicsRows& rows, const Eigen::VectorXd& left,
                                                 const std::vector<std::string>& files,
                                                 const std::string& unit) {
  std::map<int, std::vector<Touch>> touches;  // by recording
  for (const auto& [of, means] : left_means(rows, left)) {
    if (means.size() < fewest_means) continue;
    std::vector<double> torques;
    for (const LeftMean& mean : means) torques.push_back(mean.torque);
    const double usual = robust_deviation(torques);
    const auto is_far = [&](double torque) { return std::abs(torque) > far * usual; };
    const auto beyond = static_cast<double>(std::count_if(torques.begin(), torques.end(), is_far));
    if (!(usual > 0.0) || beyond > rare * static_cast<double>(torques.size())) continue;
    for (const LeftMean& mean : means) {
      if (is_far(mean.torque))
        add({mean.time, mean.time + cluster_length, mean.torque, usual, of.second}, touches[of.first]);
    }
  }
  std::vector<std::string> warnings;
  for (const auto& [recording, of_recording] : touches) {
    for (const Touch& touch : of_recording) {
      warnings.push_back(
          fmt::format("{}: something touches the robot from about {:.1f} to {:.1f} s: there {:.2g} {} of "
                      "drive {} are left, "
                      "{:.0f} times what is usual; take a stretch of the recording without that",
                      files[static_cast<std::size_t>(recording)], touch.from, touch.to,
                      std::abs(touch.torque), unit, touch.drive + 1, std::abs(touch.torque) / touch.usual));
    }
  }
  return warnings;
}

std::vector<std::string> warnings_about_drift(const DynamicsRows& rows, const Eigen::VectorXd& left,
                                              const std::vector<std::string>& files,
                                              const std::string& unit) {
  std::vector<std::string> warnings;
  for (const auto& [of, means] : left_means(rows, left)) {
    if (means.size() < fewest_means || means.back().time - means.front().time < shortest) continue;
    for (const auto& [value, what] :
         {std::pair(&LeftMean::torque, "torque"), std::pair(&LeftMean::friction, "friction")}) {
      const Drift drift = drift_of(means, value);
      const bool is_clear = std::abs(drift.change) > clear * drift.deviation;
      if (!is_clear ||
          std::abs(drift.change) < worth_telling * root_mean_square(of_drive(rows, rows.torque, of.second)))
        continue;
      warnings.push_back(
          fmt::format("{}: the {} of drive {} changes by {:+.2g} {} from begin to end; where it warms up, "
                      "let it move for as "
                      "long before it is recorded, and else look at the zero of its current",
                      files[static_cast<std::size_t>(of.first)], what, of.second + 1, drift.change, unit));
    }
  }
  return warnings;
}

}  // namespace flinch
