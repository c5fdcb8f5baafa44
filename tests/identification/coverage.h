#pragma once

#include <cstdint>
#include <map>
#include <string>

namespace flinch::test {

/// How many of the 95 % intervals that calibrations state cover the truth.
class Coverage {
 public:
  /// Counts the interval of a parameter in one more calibration: how far off it is, and its stated deviation.
  void count(const std::string& parameter, double error, double deviation);

  /// Prints a row for each parameter: mean and deviation of its errors over the stated deviations, which are
  /// 0 and 1 where these are right, and the share of its intervals that cover the truth.
  void print() const;
  int covered() const;
  int intervals() const;
  double share() const;    ///< of all intervals
  double scatter() const;  ///< root mean square of all errors over their stated deviations: 1 is right
  /// The probability that so few intervals of a parameter, or fewer, cover the truth where each does with a
  /// probability of 0.95: of the parameter for which it is least. Calibrations are independent, so it is
  /// exact.
  double probability() const;

 private:
  struct Count {
    int covered = 0, all = 0;
    double sum = 0.0, squares = 0.0;  // of errors over stated deviations
  };
  std::map<std::string, Count> of_parameter_;
};

/// Torque constants from random pulls at a robot with three drives: cogging of up to 0.5 Nm, 2 degrees of
/// misalignment, noise.
Coverage cover_torque_constants(int calibrations, std::uint64_t first_seed);

/// Pose, biases and delay of an IMU that is mounted anew, on a platform that moves in the plane along four
/// random waves for 4 s; noise of the rig's IMU, low-passed as recordings are.
Coverage cover_imu_poses(int calibrations, std::uint64_t first_seed);

/// How far off the robots are from what a calibration believes of them beforehand.
enum class RobotsDrawn {
  as_believed,       ///< from that belief: so intervals that use it hold the truth as often as they say
  near_their_model,  ///< inertia by up to 10 %, friction by up to 20 %: nearer than is believed
};

/// The rig's robot along random waves for 20 s; motors that cog by up to 0.5 Nm, noise.
Coverage cover_dynamics(int calibrations, std::uint64_t first_seed, RobotsDrawn drawn);

}  // namespace flinch::test
