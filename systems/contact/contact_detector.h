#pragma once

#include <memory>

#include "systems/contact/component_bounds.h"
#include "systems/framework/system.h"
#include "systems/robot/parallel_robot.h"
#include "systems/signals/contact_detection.h"
#include "systems/signals/reset_command.h"
#include "systems/signals/wrench_estimate.h"

namespace flinch {

/// Bounds on the magnitude of every force and every moment component of a wrench.
struct WrenchThreshold {
  double force = 0.0;   ///< [N]
  double moment = 0.0;  ///< [Nm]
};

/// The same, which may differ from component to component.
struct ReactionThreshold {
  ComponentBounds force = 0.0;   ///< [N]
  ComponentBounds moment = 0.0;  ///< [Nm]
};

/// One threshold a component: forces first.
PlatformVector of_components(const WrenchThreshold& threshold, const ParallelRobot& robot);

struct ContactDetectorSettings {
  ReactionThreshold reaction{10.0, 1.0};  ///< epsilon_r, [SafePR] V-B
  WrenchThreshold hard{60.0, 3.0};        ///< epsilon_g, [PAR]
  Time period = 1ms;
};

/// Says that the robot is touched when a component of the estimated wrench reaches its threshold, [SafePR]
/// Alg. 5. The level rises and never falls until the reset, which forgets it before this tick's estimate is
/// judged. An estimate that is not valid, not finite or of the wrong size has no level, raises none, and does
/// not undo a detection.
class ContactDetector final : public System {
  State<ContactDetection> previous_ = state<ContactDetection>("previous");

 public:
  /// Throws SetupError for thresholds that are not positive, do not fit the robot, or a hard one below that
  /// of the reaction.
  explicit ContactDetector(const std::shared_ptr<const ParallelRobot>& robot,
                           const ContactDetectorSettings& settings = {});

  InputPort<WrenchEstimate> wrench = input<WrenchEstimate>("wrench");
  InputPort<ResetCommand> reset = input<ResetCommand>("reset");
  OutputPort<ContactDetection> contact =
      output<&ContactDetector::detect>("contact", wrench, reset, previous_, clock);

 private:
  ContactDetection detect(const WrenchEstimate& estimate, const ResetCommand& command,
                          const ContactDetection& previous, Time now) const;
  ContactLevel level(const PlatformVector& components) const;

  PlatformVector reaction_;
  PlatformVector hard_;
};

}  // namespace flinch
