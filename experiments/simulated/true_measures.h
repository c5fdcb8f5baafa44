#pragma once

#include <memory>

#include "systems/framework/system.h"
#include "systems/robot/mechanism.h"
#include "systems/signals/platform_motion.h"
#include "systems/signals/workspace_measures.h"

namespace flinch {

/// How near the simulated robot really is to what it must stay away from: what the controller's model says
/// of the measured pose, of the true one and by the true robot. For verdicts; no control block may read it.
class TrueMeasures final : public System {
 public:
  explicit TrueMeasures(std::shared_ptr<const Mechanism> robot) : robot_(std::move(robot)) {}

  InputPort<PlatformMotion> platform = input<PlatformMotion>("platform");
  OutputPort<WorkspaceMeasures> measures = output<&TrueMeasures::measure>("measures", platform);

 private:
  WorkspaceMeasures measure(const PlatformMotion& motion) const;

  std::shared_ptr<const Mechanism> robot_;
};

}  // namespace flinch
