#pragma once

#include <memory>
#include <optional>

#include "diagrams/contact_control.h"
#include "diagrams/external_station.h"
#include "systems/framework/diagram.h"

namespace flinch {

struct Scenario;

/// The control path of a scenario before a robot outside this program. The outputs of the diagram are what is
/// recorded, under the names that 'flinch run' uses in simulation; its inputs are the operator's buttons and
/// targets, the timing of its ticks, and what comes from the robot.
struct LiveExperiment {
  std::unique_ptr<Diagram> diagram;
  ExternalStation station;
  ContactControl control;
  InputPort<OperatorCommand> operator_command;  ///< where the scenario has an operator, beside what he does
  InputPort<TargetCommand> target;              ///< likewise
  /// What touches the robot and where, for a program that knows it: with `control.contact_is_told`.
  std::optional<InputPort<ContactClassification>> told_classification;
  std::optional<InputPort<ContactLocation>> told_location;
  InputPort<TickTiming> tick_timing;  ///< for RealtimeRunner::feed_timing()
  int translations = 2;               ///< directions in which the platform moves
};

/// What is behind the experiment's station.
enum class RobotOutside {
  real,      ///< or one that moves as if it were
  lockstep,  ///< a simulated one that waits for each tick: what can be simulated can be done with it
};

/// Throws SetupError for settings that do not fit together, and for a scenario with an `operator` where the
/// robot is real.
LiveExperiment build_live_experiment(const Scenario& scenario, RobotOutside robot = RobotOutside::real);

/// How long the platform takes from `pose` to the start of the scenario's motion; 0 where there is none.
Time approach_from(const Configuration& pose, const Scenario& scenario);

}  // namespace flinch
