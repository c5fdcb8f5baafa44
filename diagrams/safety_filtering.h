#pragma once

#include <optional>

#include "diagrams/control_stages.h"
#include "systems/signals/braking_status.h"
#include "systems/signals/gate_fault.h"
#include "systems/signals/gate_status.h"
#include "systems/signals/limit_status.h"

namespace flinch {

/// What of the drives' torques motions and stops are planned with: the rest is for what pushes, and for what
/// the model does not know.
inline constexpr double planned_torque_share = 0.7;

/// Motion and disturbance with hardly a lag.
struct FollowedMotion {
  OutputPort<PlatformMotion> platform;
  OutputPort<WrenchEstimate> disturbance;
};

/// Torques within the robot's limits, and what was done for that.
struct LimitedTorques {
  OutputPort<TorqueCommand> torque;
  OutputPort<LimitStatus> status;
  OutputPort<BrakingStatus> braking;  ///< whether they could be kept when a contact was detected
  /// Where limits are kept: what the drives are told, to be connected, and the motion for who keeps them too.
  std::optional<InputPort<TorqueCommand>> commanded{};
  std::optional<FollowedMotion> followed{};
};

/// Adds a SafetyFilter, "limits", for the torques that the laws request, with a filter of its own that
/// follows motion and disturbance with hardly a lag, and the model there; and "braking", which judges whether
/// the robot could stop within them. Where limits are never to be kept it adds nothing but statuses that say
/// so.
LimitedTorques add_safety_filter(const StageContext& site, const ReactionPorts& given,
                                 OutputPort<TorqueCommand> requested);

/// What is known of a stop.
struct StopPorts {
  OutputPort<TorqueCommand> torque;  ///< of the controlled stop
  OutputPort<FaultReport> faults;
  OutputPort<GateStatus> gate;
  OutputPort<TorqueCommand> commanded;  ///< what the drives are told
};

/// Adds a second one for the torques of the controlled stop. It keeps the same limits as long as no fault
/// calls in doubt what that needs; otherwise the stop's torques are handed on as they are.
OutputPort<TorqueCommand> add_kept_stop(const StageContext& site, const FollowedMotion& followed,
                                        const StopPorts& stop);

}  // namespace flinch
