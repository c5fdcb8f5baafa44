#include "tests/systems/robot/random_states.h"

#include <cmath>
#include <random>

namespace flinch::test {

std::vector<MotionState> random_states(const MechanismCase& mechanism, int count, unsigned seed) {
  std::mt19937 generator(seed);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const auto within = [&](const PlatformVector& widths) {
    PlatformVector drawn = widths;
    for (double& entry : drawn) entry *= uniform(generator);
    return drawn;
  };
  const ParallelRobot& robot = *mechanism.robot;
  std::vector<MotionState> states;
  while (static_cast<int>(states.size()) < count) {
    const Configuration pose = robot.space().plus(robot.home_pose(), within(mechanism.region));
    const PlatformVector velocity = within(mechanism.velocity);
    Kinematics k;
    robot.kinematics(pose, velocity, k);
    if (!k.valid || std::abs(k.det_A) < mechanism.least_det_A) continue;
    states.push_back({pose, velocity});
  }
  return states;
}

}  // namespace flinch::test
