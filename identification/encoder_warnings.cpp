#include "identification/encoder_warnings.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "systems/framework/recorded_values.h"
#include "systems/signals/joint_reading.h"

namespace flinch {
namespace {

constexpr std::size_t most_samples = 100;
constexpr double degree = std::numbers::pi / 180.0;
constexpr double largest_offset = 10.0 * degree;  // that is looked for [rad, or a hundredth of it in m]
constexpr double telling = 3.0;                   // by so much it must close the legs better
constexpr double least_offset = 0.2 * degree;     // below it nobody need care
constexpr int halvings = 24;

struct Sample {
  JointVector active, passive;
};

std::vector<Sample> samples_of(const Recording& recording) {
  const auto joints = read<JointReading>(recording, "joints");
  std::vector<Sample> samples;
  const std::size_t step = std::max<std::size_t>(1, joints.size() / most_samples);
  for (std::size_t k = 0; k < joints.size(); k += step) {
    const JointReading reading = joints[k];
    if (reading.valid)
      samples.push_back({reading.active, reading.passive_valid ? reading.passive : JointVector()});
  }
  return samples;
}

/// An encoder: of a drive, or behind those a passive one.
void shift(Sample& sample, int encoder, double offset) {
  const int drives = static_cast<int>(sample.active.size());
  (encoder < drives ? sample.active[encoder] : sample.passive[encoder - drives]) += offset;
}

/// Root mean square of what is missing between legs and platform, with one encoder shifted [m]; nothing where
/// fewer than nine tenths of the samples have a pose.
std::optional<double> closure(const ParallelRobot& robot, const std::vector<Sample>& samples, int encoder,
                              double offset) {
  double sum = 0.0;
  std::size_t count = 0;
  for (Sample sample : samples) {
    if (encoder >= 0) shift(sample, encoder, offset);
    const Configuration start = robot.start_pose(sample.active, sample.passive);
    const ForwardSolution solution =
        robot.forward_kinematics(sample.active, start, robot.working_mode(sample.passive));
    if (!solution.converged) continue;
    const double miss = robot.chain_closure_error(sample.active, sample.passive, solution.pose);
    sum += miss * miss;
    ++count;
  }
  if (count == 0 || 10 * count < 9 * samples.size()) return std::nullopt;
  return std::sqrt(sum / static_cast<double>(count));
}

/// The offset of an encoder that closes the legs best, and how well.
struct Offset {
  double value = 0.0;
  double left = 0.0;  ///< [m]
};

/// By golden section: the miss has one valley where the offset is small.
std::optional<Offset> best_offset(const ParallelRobot& robot, const std::vector<Sample>& samples, int encoder,
                                  double most) {
  constexpr double golden = 0.61803398874989484820;
  const auto miss = [&](double offset) { return closure(robot, samples, encoder, offset).value_or(1e9); };
  double a = -most, b = most, x = b - golden * (b - a), y = a + golden * (b - a);
  double fx = miss(x), fy = miss(y);
  for (int i = 0; i < halvings; ++i) {
    if (fx < fy) {
      b = y, y = x, fy = fx;
      x = b - golden * (b - a), fx = miss(x);
    } else {
      a = x, x = y, fx = fy;
      y = a + golden * (b - a), fy = miss(y);
    }
  }
  const double value = 0.5 * (a + b);
  const std::optional<double> left = closure(robot, samples, encoder, value);
  if (!left) return std::nullopt;
  return Offset{value, *left};
}

std::vector<std::string> warnings_about_zeros(const ParallelRobot& robot,
                                              const std::vector<Sample>& samples) {
  const std::optional<double> before = closure(robot, samples, -1, 0.0);
  if (!before) return {};
  std::optional<Offset> best;
  int encoder = -1;
  const int drives = robot.drives();
  for (int e = 0; e < drives + robot.passive_joints(); ++e) {
    const bool turns = e >= drives || robot.drive_kind(e) == DriveKind::revolute;
    const std::optional<Offset> found =
        best_offset(robot, samples, e, turns ? largest_offset : 0.01 * largest_offset);
    if (!found || (best && found->left >= best->left)) continue;
    best = found;
    encoder = e;
  }
  if (!best || best->left * telling > *before) return {};
  const bool turns = encoder >= drives || robot.drive_kind(encoder) == DriveKind::revolute;
  if (std::abs(best->value) < (turns ? least_offset : 0.01 * least_offset)) return {};
  const std::string what = encoder < drives ? fmt::format("drive {}", encoder + 1)
                                            : fmt::format("passive joint {}", encoder - drives + 1);
  return {fmt::format(
      "the legs miss the platform by {:.2g} mm, and by {:.2g} mm if the encoder of {} says {:+.3g} {} "
      "more: its zero is off by that",
      1e3 * *before, 1e3 * best->left, what, turns ? best->value / degree : 1e3 * best->value,
      turns ? "degrees" : "mm")};
}

}  // namespace

std::vector<std::string> warnings_about_encoders(const Recording& recording, const ParallelRobot& robot) {
  const std::vector<Sample> samples = samples_of(recording);
  std::vector<Sample> closed;
  for (const Sample& sample : samples) {
    if (sample.passive.size() == robot.passive_joints() && robot.passive_joints() > 0)
      closed.push_back(sample);
  }
  return warnings_about_zeros(robot, closed);
}

std::vector<std::string> warnings_about_turns(const Recording& recording, const ParallelRobot& robot) {
  constexpr double turn = 2.0 * std::numbers::pi;
  const std::vector<Sample> samples = samples_of(recording);
  std::vector<std::string> warnings;
  for (int i = 0; i < robot.drives() && !samples.empty(); ++i) {
    if (robot.drive_kind(i) != DriveKind::revolute) continue;
    double mean = 0.0;
    for (const Sample& sample : samples) mean += sample.active[i] / static_cast<double>(samples.size());
    const double turns = std::floor(std::abs(mean) / turn + 0.25);  // a reading may have passed half a turn
    if (turns < 1.0) continue;
    warnings.push_back(
        fmt::format("the encoder of drive {} says {:.2f} rad on average, {:.0f} full turn{} off: what "
                    "repeats along its way is then counted from elsewhere; take its zero anew",
                    i + 1, mean, turns, turns > 1.0 ? "s" : ""));
  }
  return warnings;
}

}  // namespace flinch
