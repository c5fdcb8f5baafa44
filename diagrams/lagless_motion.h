#pragma once

#include <string>

#include "diagrams/control_stages.h"
#include "systems/estimators/disturbance_filter.h"

namespace flinch {

/// Where a further block of a stage is added, called as the stage and `what` it is.
StageSite part(const StageSite& site, const std::string& what);

/// The drive torque of the present, without the filter that aligns it with the velocity.
OutputPort<DriveTorque> add_torque_as_it_is(const StageSite& site, const SensedPorts& given);

/// A filter that follows motion and disturbance by that torque.
DisturbanceFilter& add_encoder_filter(const StageSite& site, const MotionPorts& given,
                                      const DisturbanceFilterSettings& settings);

/// Ports with a motion whose velocity hardly lags, and the model there.
struct LaglessPorts : AcceleratedPorts {
  OutputPort<WrenchEstimate> disturbance;  ///< that the filter has found which follows the motion
};
LaglessPorts without_lag(const StageSite& site, const AcceleratedPorts& given);

}  // namespace flinch
