#include "experiments/scenario/scenario_estimators.h"

#include <span>

#include "diagrams/contact_control_settings.h"
#include "systems/config/config_reader.h"
#include "systems/robot/parallel_robot.h"

namespace flinch {
namespace {

/// What is left to the robot's size is written out, so that a file can change one entry.
void read(ConfigReader reader, const ParallelRobot& robot, MomentumObserverSettings& settings) {
  if (settings.gain.size() == 0) settings.gain.setConstant(robot.dof(), 20.0);
  const std::span<double> gain(settings.gain.data(), static_cast<std::size_t>(settings.gain.size()));
  reader.numbers("gain", unit::per_s, gain, positive);
}

void read(ConfigReader reader, MomentumKalmanFilterSettings& settings) {
  reader.number("momentum_deviation", unit::Ns, settings.translation.momentum_deviation, positive);
  reader.number("angular_momentum_deviation", unit::Nms, settings.rotation.momentum_deviation, positive);
  reader.number("force_density", unit::N2_per_s, settings.translation.force_density, positive);
  reader.number("moment_density", unit::N2m2_per_s, settings.rotation.force_density, positive);
}

}  // namespace

void read_estimators(ConfigReader& control, const ParallelRobot& robot, ContactControlSettings& settings) {
  read(control.section("momentum_observer"), robot, settings.momentum_observer);
  read(control.section("momentum_kalman_filter"), settings.momentum_kalman_filter);
}

}  // namespace flinch
