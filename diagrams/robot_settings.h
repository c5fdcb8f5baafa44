#pragma once

#include "diagrams/contact_control_settings.h"
#include "systems/robot/drive_parameters.h"
#include "systems/robot/parallel_robot.h"
#include "systems/robot/workspace_limits.h"

namespace flinch {

/// The settings with which a robot begins, in C++ as in 'flinch run': what depends on the robot is filled in
/// from what its file says, in the units of its drives; the rest are the defaults.
///   torque constants, delay and cogging, torque range and its rates; speeds and errors that stop a drive;
///   what a motor current may change while the encoder of its drive stands still: 6 % of the largest torque;
///   below which speed a drive counts as at rest: 1/160 of the largest;
///   damping of the controlled stop: the least inertia that a drive feels at home, in 29 ms, [PAR]; after a
///   hard contact from a quarter of the largest speed on, less below;
///   gains of the velocity level: that inertia times 106 1/s, and times 1.76 1/s;
///   stiffness of the nominal impedance: that of the rig, where the platform at home then has natural
///   frequencies from 10 to 80 rad/s, else that of the nearer one;
///   constraints: constraints_for().
/// `period`: from tick to tick, see know_period().
ContactControlSettings settings_for(const ParallelRobot& robot, const DriveParameters& drives,
                                    const WorkspaceLimits& limits, Time period = 1ms);

/// What follows from the time between two ticks of the control path. Samples may be missing, late and
/// repeated as long at every rate, and for one tick at least; filters that make several steps in a tick make
/// them as short as at 1 kHz.
void know_period(Time period, ContactControlSettings& settings);

/// What the drive torques follow from, as far as it is known of the drives.
void know_drives(const DriveParameters& drives, DriveTorqueSettings& settings);

}  // namespace flinch
