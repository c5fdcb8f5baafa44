#pragma once

#include <cstdint>
#include <memory>

#include "plant/rig_dynamics.h"
#include "plant/sensor_noise.h"
#include "systems/framework/system.h"
#include "systems/robot/leg_bases.h"
#include "systems/signals/base_force_reading.h"

namespace flinch {

/// Force sensors below the base joints.
struct SimulatedBaseForcesSettings {
  std::shared_ptr<const LegBases> bases;  ///< of the robot that stands there; none: no such sensors
  bool ideal = false;                     ///< Readings are the truth.
  double noise = 0.1;                     ///< Standard deviation of white noise [N]; assumed.
};

/// Measures at every tick what the base does to each leg, under the torque that acted until then. What bodies
/// of the robot do to one another is not in it, nor what ropes pull.
class SimulatedBaseForces final : public System {
  using Noise = NormalNumbers<3 * max_dof>;

 public:
  SimulatedBaseForces(const SimulatedBaseForcesSettings& settings, std::shared_ptr<const Mechanism> robot,
                      std::uint64_t seed);

 private:
  SimulatedBaseForcesSettings settings_;
  std::shared_ptr<const Mechanism> robot_;
  State<Noise> noise_;

 public:
  InputPort<RigSnapshot> snapshot = input<RigSnapshot>("snapshot");
  OutputPort<BaseForceReading> forces =
      output<&SimulatedBaseForces::measure>("forces", clock, snapshot, noise_);

 private:
  Update draw_ = update<&SimulatedBaseForces::draw>(noise_);

  void measure(Time now, const RigSnapshot& rig, const Noise& noise, BaseForceReading& reading) const;
  void draw(Noise& noise) const { noise.draw(); }
};

}  // namespace flinch
