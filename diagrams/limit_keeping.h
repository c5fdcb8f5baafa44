#pragma once

#include "diagrams/control_stages.h"
#include "systems/signals/limit_status.h"

namespace flinch {

/// Torques within the robot's limits, and what was done for that.
struct KeptTorques {
  OutputPort<TorqueCommand> torque;
  OutputPort<LimitStatus> status;
};

/// Adds a LimitKeeper, "limits", for the torques that the laws request, with a filter of its own that follows
/// motion and disturbance with hardly a lag, and the model there. Where limits are never to be kept it adds
/// nothing but a status that says so.
KeptTorques add_limit_keeper(const StageSite& site, const ReactionPorts& given,
                             OutputPort<TorqueCommand> requested);

}  // namespace flinch
