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

void read(ConfigReader reader, SlidingModeObserverSettings& settings) {
  reader.number("force_rate", unit::N_per_s, settings.force_rate, positive);
  reader.number("moment_rate", unit::Nm_per_s, settings.moment_rate, positive);
  reader.number("damping", unit::per_s, settings.damping, positive);
  reader.integer("substeps", settings.substeps, 1, 100);
}

}  // namespace

void read_estimators(ConfigReader& control, const ParallelRobot& robot, ContactControlSettings& settings) {
  read(control.section("momentum_observer"), robot, settings.momentum_observer);
  read(control.section("momentum_kalman_filter"), settings.momentum_kalman_filter);
  read(control.section("sliding_mode_observer"), settings.sliding_mode_observer);
}

}  // namespace flinch
