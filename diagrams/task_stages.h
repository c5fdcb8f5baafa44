#pragma once

#include <vector>

#include "diagrams/control_stages.h"

namespace flinch {

struct ContactControlSettings;
class ParallelRobot;

/// Laws of the nominal motion that serve tasks by priority: "velocity_tracking", "acceleration_tracking",
/// "torque_tracking", after the level of [SafePR] IV-C to IV-E.
std::vector<ControlLaw> tracking_stages();

/// Laws of the reaction that do so: "velocity_reaction", "acceleration_reaction", "torque_reaction",
/// and "strict_reaction": the tasks of the torque level, whose constraints the safety filter holds instead.
std::vector<ControlLaw> task_reaction_stages();

/// What "strict_reaction" needs: the safety filter holds the safety values of the tasks' constraints, in the
/// nominal motion too, and a speed of the platform from which the drives can brake in time: 0.58 of that at
/// which, at the home pose, whichever drive gets there first is at its largest speed (2.1 m/s on the planar
/// rig, found by trial). No limit that is there is loosened.
void keep_constraints_strictly(const ParallelRobot& robot, ContactControlSettings& settings);

}  // namespace flinch
