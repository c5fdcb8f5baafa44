#pragma once

#include <memory>

#include "plant/simulated_station.h"
#include "plant/sundials_integrator.h"
#include "systems/framework/constant.h"
#include "systems/framework/context.h"
#include "systems/framework/diagram_builder.h"
#include "systems/framework/simulator.h"
#include "systems/signals/brake_command.h"
#include "tests/plant/rig_scene.h"
#include "tests/plant/truth_servo.h"

namespace flinch::test {

/// The rig of the papers as a station: ideal sensors, no obstacle.
inline SimulatedStationSettings rig_station() {
  SimulatedStationSettings settings;
  settings.rig.robot = individual_rig(RigFriction::test_rig);
  settings.drives.torque_constant = Eigen::Vector3d(6.021, 6.6116, 6.7315);
  return with_ideal_sensors(settings);
}

/// A simulated station whose platform a servo moves along a path.
class ServoedStation {
 public:
  explicit ServoedStation(const SimulatedStationSettings& settings, const Path& path = {},
                          std::unique_ptr<Integrator> integrator = std::make_unique<SundialsIntegrator>(),
                          Time tick = 1ms)
      : ServoedStation(DiagramBuilder("test", tick), settings, path, std::move(integrator)) {}

  void step() { simulator_.step(context_); }
  /// Runs to `end` and evaluates the outputs there.
  void advance_to(Time end) { simulator_.advance_to(context_, end); }

  /// The value of a port, as of the last evaluation.
  template <class Port>
  const typename Port::Value& get(Port port) const {
    return context_.get(port);
  }

  const PlantTruth& truth() const { return get(station.plant_truth); }
  const ContactTruth& contact() const { return get(station.contact_truth); }
  Context& context() { return context_; }
  const Diagram& diagram() const { return *diagram_; }
  Simulator& simulator() { return simulator_; }

  SimulatedStation station;

 private:
  ServoedStation(DiagramBuilder builder, const SimulatedStationSettings& settings, const Path& path,
                 std::unique_ptr<Integrator> integrator)
      : station(add_simulated_station(builder, settings)),
        diagram_(wire(builder, settings, path)),
        context_(diagram_->make_context()),
        simulator_(*diagram_, std::move(integrator)) {}

  std::unique_ptr<Diagram> wire(DiagramBuilder& builder, const SimulatedStationSettings& settings,
                                const Path& path) const {
    auto& servo = builder.add<TruthServo>("servo", settings.rig.robot, path);
    auto& brake = builder.add<Constant<BrakeCommand>>("brake", BrakeCommand{.engage = false});
    builder.connect(station.plant_truth, servo.truth);
    builder.connect(servo.torque, station.torque_command);
    builder.connect(brake.value, station.brake);
    return builder.build();
  }

  std::unique_ptr<Diagram> diagram_;
  Context context_;
  Simulator simulator_;
};

}  // namespace flinch::test
