#include "plant/true_robot.h"

#include <cstddef>

#include "systems/foundation/setup_error.h"
#include "systems/robot/five_bar.h"
#include "systems/robot/hexapod.h"
#include "systems/robot/planar_rrr.h"

namespace flinch {
namespace {

double scale_of(const JointVector& scales, std::size_t index) {
  const auto i = static_cast<Eigen::Index>(index);
  return i < scales.size() ? scales[i] : 1.0;
}

void scale(JointFriction& friction, double factor) {
  friction.viscous *= factor;
  friction.coulomb *= factor;
}

template <class Parameters>
void deviate_planar_legs(Parameters& robot, const RobotDeviation& deviation) {
  for (std::size_t i = 0; i < robot.legs.size(); ++i) {
    PlanarLegParameters& leg = robot.legs[i];
    const double inertia = scale_of(deviation.leg_inertia_scale, i);
    leg.inertia = {leg.inertia.p1 * inertia, leg.inertia.p2 * inertia, leg.inertia.p3 * inertia};
    scale(leg.active_friction, scale_of(deviation.drive_friction_scale, i));
    scale(leg.passive_friction, scale_of(deviation.passive_friction_scale, i));
  }
}

std::shared_ptr<const Mechanism> deviating(PlanarRrrParameters robot, const RobotDeviation& deviation) {
  deviate_planar_legs(robot, deviation);
  robot.platform_mass = robot.platform_mass * deviation.platform_inertia_scale + deviation.payload;
  robot.platform_inertia *= deviation.platform_inertia_scale;
  return std::make_shared<const PlanarRrr>(robot);
}

std::shared_ptr<const Mechanism> deviating(FiveBarParameters robot, const RobotDeviation& deviation) {
  deviate_planar_legs(robot, deviation);
  robot.platform_mass = robot.platform_mass * deviation.platform_inertia_scale + deviation.payload;
  return std::make_shared<const FiveBar>(robot);
}

std::shared_ptr<const Mechanism> deviating(HexapodParameters robot, const RobotDeviation& deviation) {
  for (std::size_t i = 0; i < robot.legs.size(); ++i) {
    robot.legs[i].mass_scale *= scale_of(deviation.leg_inertia_scale, i);
    scale(robot.legs[i].drive_friction, scale_of(deviation.drive_friction_scale, i));
    scale(robot.legs[i].universal_friction, scale_of(deviation.passive_friction_scale, i));
  }
  robot.platform = scaled(robot.platform, deviation.platform_inertia_scale);
  if (deviation.payload > 0.0) {
    robot.platform = together(robot.platform, RigidBodyInertia{.mass = deviation.payload});
  }
  return std::make_shared<const Hexapod>(robot);
}

}  // namespace

std::shared_ptr<const Mechanism> true_robot(const std::shared_ptr<const Mechanism>& robot,
                                            const RobotDeviation& deviation) {
  if (const auto* planar = dynamic_cast<const PlanarRrr*>(robot.get())) {
    return deviating(planar->parameters(), deviation);
  }
  if (const auto* five_bar = dynamic_cast<const FiveBar*>(robot.get())) {
    return deviating(five_bar->parameters(), deviation);
  }
  if (const auto* hexapod = dynamic_cast<const Hexapod*>(robot.get())) {
    return deviating(hexapod->parameters(), deviation);
  }
  throw SetupError("a robot called '" + robot->name() +
                   "' is of a kind whose parameters cannot be made to differ");
}

}  // namespace flinch
