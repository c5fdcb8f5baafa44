#pragma once

#include "tests/fault/link/link_fault_table.h"

/// The trials of the table, each some seconds long. They leave what is wrong as failures of the present test.
namespace flinch::test {

// Programs and cables that fail.
TrialOutcome kill_commander();
TrialOutcome hang_commander();
TrialOutcome kill_robot();
TrialOutcome hang_robot();
TrialOutcome cut_link();

// A bad network, a bad clock.
TrialOutcome lose_samples();
TrialOutcome delay_samples();
TrialOutcome duplicate_and_reorder_samples();
TrialOutcome step_clock();

// Others on the bus.
TrialOutcome second_robot();
TrialOutcome second_commander();
TrialOutcome replay_commands();
TrialOutcome wrong_version();
TrialOutcome other_robot_file();

// Bad sensors.
TrialOutcome broken_joints();
TrialOutcome broken_currents();
TrialOutcome missing_imu();

}  // namespace flinch::test
