#pragma once

#include "experiments/verdict/recorded_truth.h"
#include "systems/robot/mechanism.h"

namespace flinch::test {

/// What drives can do against a contact: from some time after the touch on, all of them push away from it.
struct BestReaction {
  double begins_after = 0.0;  ///< [s]
  double torque_rate = 20e3;  ///< of a drive [Nm/s]
  double max_torque = 100.0;  ///< [Nm]
};

/// Which force f a contact reaches whatever is done about it [N]: the robot's effective mass at the contact
/// runs against an undamped spring,
///   df = k v,   dv = -(f g^T M_x^-1 g + tau^T |J_qa,x M_x^-1 g|),
/// with the platform wrench g of a unit force and the torque tau of each drive, all pushing away. (Derived.)
/// Mass and direction stay as they are at the touch, torques are counted from those that moved the robot
/// there, friction and damping are left out: no strict bound, but an estimate that no run should stay below.
/// It looks at nothing that a reaction does. `touched` is the first tick with a force, `stiffness` that of
/// what is touched [N/m]. 0 where the model does not hold, and where not one body touches alone.
double unavoidable_force(const Mechanism& robot, const RecordedTruth& moving, const RecordedContact& touched,
                         double stiffness, const BestReaction& best);

}  // namespace flinch::test
