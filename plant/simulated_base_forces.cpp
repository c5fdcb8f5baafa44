#include "plant/simulated_base_forces.h"

#include <array>
#include <utility>

#include "systems/foundation/setup_error.h"
#include "systems/robot/kinematics.h"

namespace flinch {
namespace {

const LegBases& required(const SimulatedBaseForcesSettings& settings) {
  if (!settings.bases) throw SetupError("base forces: nothing is known of the base joints");
  return *settings.bases;
}

}  // namespace

SimulatedBaseForces::SimulatedBaseForces(const SimulatedBaseForcesSettings& settings,
                                         std::shared_ptr<const Mechanism> robot, std::uint64_t seed)
    : settings_(settings),
      robot_(std::move(robot)),
      noise_(state<Noise>("noise", Noise(required(settings).size(), derive_seed(seed, "noise")))) {}

void SimulatedBaseForces::measure(Time now, const RigSnapshot& rig, const Noise& noise,
                                  BaseForceReading& reading) const {
  reading = BaseForceReading();
  reading.acquired = now;
  Kinematics at;
  if (rig.reachable) robot_->kinematics(rig.pose, rig.velocity, at);
  if (!at.reachable) return;
  std::array<ForceOnBody, max_touches> touches;
  const int count = rig.contacts.touch_count;
  for (int i = 0; i < count; ++i) {
    const auto index = static_cast<std::size_t>(i);
    const Touch& touch = rig.contacts.touches[index];
    const int directions = settings_.bases->directions();
    touches[index] = {touch.body, touch.point.head(directions), touch.force_on_robot.head(directions)};
  }
  settings_.bases->forces(at, rig.acceleration, rig.torque_on_legs,
                          {touches.data(), static_cast<std::size_t>(count)}, reading.force_in_base);
  reading.valid = true;
  if (!settings_.ideal) reading.force_in_base += settings_.noise * noise.values();
}

}  // namespace flinch
