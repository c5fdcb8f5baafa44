#pragma once

#include <memory>
#include <string>

#include "plant/contact_truth.h"
#include "plant/plant_truth.h"
#include "systems/framework/system.h"
#include "systems/robot/parallel_robot.h"
#include "systems/signals/contact_classes.h"
#include "systems/signals/contact_location.h"
#include "systems/signals/platform_motion.h"

namespace flinch {

/// Tells what really touches the simulated robot, as a classifier and a locator would that never err: for
/// experiments that examine what is done about it. A clamping begins where one of the two links is touched
/// from between them: where the experiment is made for one, it is told from then on.
class ContactTeller final : public System {
 public:
  /// `made_for`: the name of the class that the experiment brings about; empty or any other: what touches
  /// tells.
  ContactTeller(std::shared_ptr<const ParallelRobot> robot, const std::string& made_for);

  InputPort<ContactTruth> contact = input<ContactTruth>("contact");
  InputPort<PlatformMotion> platform = input<PlatformMotion>("platform");
  OutputPort<ContactClassification> classification =
      output<&ContactTeller::classify>("classification", contact, platform);
  OutputPort<ContactLocation> location = output<&ContactTeller::locate>("location", contact, platform);

 private:
  ContactClassification classify(const ContactTruth& truth, const PlatformMotion& motion) const;
  bool begins_a_clamping(const TouchTruth& touch, const PlatformMotion& motion) const;
  ContactLocation locate(const ContactTruth& truth, const PlatformMotion& motion) const;

  std::shared_ptr<const ParallelRobot> robot_;
  ContactClasses classes_;
  int made_for_ = -1;
};

}  // namespace flinch
