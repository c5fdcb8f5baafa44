#pragma once

#include "systems/signals/brake_command.h"
#include "systems/signals/contact_detection.h"
#include "systems/signals/drive_reading.h"
#include "systems/signals/force_torque_reading.h"
#include "systems/signals/imu_reading.h"
#include "systems/signals/joint_reading.h"
#include "systems/signals/reaction_state.h"
#include "systems/signals/station_status.h"
#include "systems/signals/torque_command.h"

struct flinch_JointSample;  // drivers/idl/flinch.idl
struct flinch_DriveSample;
struct flinch_ImuSample;
struct flinch_ForceTorqueSample;
struct flinch_StatusSample;
struct flinch_TorqueSample;
struct flinch_ContactEvent;

/// Between flinch's values and those on the bus. Of times only `acquired` is copied, as it is: both ends have
/// clocks of their own. Values that do not count are zero on the bus, so that no memory leaks there. A sample
/// from the bus with more than max_dof entries, or with joints of no entries, is not valid.
namespace flinch {

void to_wire(const JointReading& reading, flinch_JointSample& sample) noexcept;
void to_wire(const DriveReading& reading, flinch_DriveSample& sample) noexcept;
void to_wire(const ImuReading& reading, flinch_ImuSample& sample) noexcept;
void to_wire(const ForceTorqueReading& reading, flinch_ForceTorqueSample& sample) noexcept;
void to_wire(const StationStatus& status, flinch_StatusSample& sample) noexcept;
void to_wire(const TorqueCommand& command, const BrakeCommand& brake, flinch_TorqueSample& sample) noexcept;
/// `now`: when both were computed.
void to_wire(const ContactDetection& detection, const ReactionState& reaction, Time now,
             flinch_ContactEvent& event) noexcept;

void from_wire(const flinch_JointSample& sample, JointReading& reading) noexcept;
void from_wire(const flinch_DriveSample& sample, DriveReading& reading) noexcept;
void from_wire(const flinch_ImuSample& sample, ImuReading& reading) noexcept;
void from_wire(const flinch_ForceTorqueSample& sample, ForceTorqueReading& reading) noexcept;
void from_wire(const flinch_StatusSample& sample, StationStatus& status) noexcept;
void from_wire(const flinch_TorqueSample& sample, TorqueCommand& command) noexcept;
void from_wire(const flinch_TorqueSample& sample, BrakeCommand& brake) noexcept;

/// Whether a command is one of no torque, or with closed brakes: with such a one a session begins.
bool asks_for_nothing(const flinch_TorqueSample& sample) noexcept;

}  // namespace flinch
