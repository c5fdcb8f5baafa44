#include "systems/robot/joint_friction.h"

#include "systems/foundation/findings.h"

namespace flinch {

JointFriction scaled(const JointFriction& friction, double factor) {
  return {.viscous = friction.viscous * factor, .coulomb = friction.coulomb * factor};
}

void find_friction_problems(const std::string& field, const JointFriction& friction, Findings& findings) {
  findings.not_negative(field + ".viscous", friction.viscous, "Nm s/rad");
  findings.not_negative(field + ".coulomb", friction.coulomb, "Nm");
}

void find_sliding_friction_problems(const std::string& field, const JointFriction& friction,
                                    Findings& findings) {
  findings.not_negative(field + ".viscous", friction.viscous, "N s/m");
  findings.not_negative(field + ".coulomb", friction.coulomb, "N");
}

}  // namespace flinch
