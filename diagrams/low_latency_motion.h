#pragma once

#include <optional>
#include <string>

#include "diagrams/control_stages.h"
#include "systems/estimators/disturbance_filter.h"
#include "systems/sensors/first_order_low_pass.h"

namespace flinch {

/// Where a further block of a stage is added, called as the stage and `what` it is.
StageContext part(const StageContext& site, const std::string& what);

// Shared by the stages of a control path: each is added once, in the name of who asks first.

/// The low pass of the velocity, where the drive torque is to lag as it does.
std::optional<LowPassSettings> torque_low_pass(const ContactControlSettings& settings);

/// The drive torque of the present or, where a low pass of the velocity is given, aligned with that.
OutputPort<DriveTorque> add_drive_torque(const StageContext& site, const SensedPorts& given,
                                         const std::optional<LowPassSettings>& aligned_with);

/// That of the present, called "present_torque".
OutputPort<DriveTorque> add_present_torque(const StageContext& site, const SensedPorts& given);

/// A filter that follows motion and disturbance by that torque.
DisturbanceFilter& add_encoder_filter(const StageContext& site, const MotionPorts& given,
                                      const DisturbanceFilterSettings& settings);

/// Ports with a motion whose velocity hardly lags, called "motion_low_latency", and the model there.
struct LowLatencyPorts : AcceleratedPorts {
  OutputPort<WrenchEstimate> disturbance;  ///< that the filter has found which follows the motion
};
LowLatencyPorts low_latency(const StageContext& site, const AcceleratedPorts& given);

}  // namespace flinch
