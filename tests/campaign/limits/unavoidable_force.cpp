#include "tests/campaign/limits/unavoidable_force.h"

#include <algorithm>

#include "systems/robot/decompositions.h"

namespace flinch::test {

double unavoidable_force(const Mechanism& robot, const RecordedTruth& moving, const RecordedContact& touched,
                         double stiffness, const BestReaction& best) {
  Kinematics at;
  Dynamics dynamics;
  robot.kinematics(moving.pose, moving.velocity, at);
  robot.dynamics(at, dynamics);
  double force = touched.strongest.force_in_base.norm();
  const bool one_alone = force > 0.0 && touched.second.body < 0;
  if (!at.valid || !dynamics.valid || !one_alone) return 0.0;
  const PlatformVector g = touched.wrench_in_base / force;
  const PlatformVector accelerated = Eigen::LLT<PlatformMatrix>(dynamics.M_x).solve(g);
  const double by_force = g.dot(accelerated), by_torque = (at.J_qa_x * accelerated).lpNorm<1>();

  constexpr double step = 1e-5, longest = 0.3;
  double speed = -g.dot(moving.velocity);  // towards what is touched
  double largest = force;
  for (double time = 0.0; time < longest && speed > 0.0; time += step) {
    const double torque = std::clamp(best.torque_rate * (time - best.begins_after), 0.0, best.max_torque);
    speed -= step * (force * by_force + torque * by_torque);
    force += step * stiffness * speed;
    largest = std::max(largest, force);
  }
  return largest;
}

}  // namespace flinch::test
