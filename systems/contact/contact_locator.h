#pragma once

#include <memory>

#include "systems/contact/wrench_uncertainty.h"
#include "systems/framework/system.h"
#include "systems/robot/link_contact.h"
#include "systems/robot/outline.h"
#include "systems/robot/parallel_robot.h"
#include "systems/signals/contact_classes.h"
#include "systems/signals/contact_location.h"
#include "systems/signals/contact_phase.h"
#include "systems/signals/wrench_estimate.h"

namespace flinch {

struct ContactLocatorSettings {
  double least_force = 1.0;  ///< below it nothing is located [N]
  /// Largest standard deviation of the fraction at which a place on a link counts as known.
  double largest_deviation = 0.15;
  /// Root mean square of f_x / f_y: how far friction lets a force on a link lean. 0: pushes are orthogonal.
  double leaning = 0.15;
  /// Standard deviation of the velocity of what is touched, along the link [m/s]; see lean_by_friction().
  double object_speed = 0.2;
};

/// Where the line of action of `wrench` enters the platform: the point of a push, [SafePR] III-A. Where it
/// misses the platform, the nearest point of the outline, not located. The point is as uncertain as it moves
/// on the outline with the line, of lines that hit it: near a tangent more than the line itself, and never
/// more than the outline is wide. `noise` and `errors` as for links.
ContactLocation locate_on_platform(const ParallelRobot& robot, const Kinematics& kinematics,
                                   const Outline& platform, const PlatformVector& wrench,
                                   const PlatformMatrix& noise, const PlatformMatrix& errors,
                                   double least_force) noexcept;

/// Where `link` is pushed, by `link_push`, with the lean that friction is expected to make while the platform
/// moves with `velocity`. What it tells of place and force is as uncertain as the wrench and that lean are.
/// `noise`: covariance of the wrench, by which its components are weighed; `errors`: the same with all that
/// it may be off by.
ContactLocation locate_on_link(const LinkContactMap& map, BodyId link, const PlatformVector& velocity,
                               const PlatformVector& wrench, const PlatformMatrix& noise,
                               const PlatformMatrix& errors, const ContactLocatorSettings& settings) noexcept;

/// The point at `fraction` of a link on the side from which a force pushes it [m].
CartesianVector pushed_point(const LinkContactMap& link, double fraction,
                             const CartesianVector& force) noexcept;

/// e^T S^-1 e of what a contact leaves of a wrench, e; S: the wrench's `covariance`.
double unexplained(const PlatformVector& missed, const PlatformMatrix& covariance) noexcept;

/// Says in closed form where the classified body is touched, anew at every tick of the contact. Of a
/// clamping, of a link that no wrench tells from the other one of its leg, and of contacts that are not
/// classified, it knows no place.
class ContactLocator final : public System {
 public:
  ContactLocator(std::shared_ptr<const ParallelRobot> robot, const ContactLocatorSettings& settings,
                 const WrenchUncertainty& uncertainty);

  InputPort<ContactPhase> phase = input<ContactPhase>("phase");
  InputPort<ContactClassification> classification = input<ContactClassification>("classification");
  InputPort<Kinematics> kinematics = input<Kinematics>("kinematics");
  InputPort<WrenchEstimate> wrench = input<WrenchEstimate>("wrench");
  InputPort<WrenchEstimate> change = input<WrenchEstimate>("change");  ///< of late, as `WrenchTrend` tells
  OutputPort<ContactLocation> location =
      output<&ContactLocator::locate>("location", phase, classification, kinematics, wrench, change);

 private:
  ContactLocation locate(const ContactPhase& contact, const ContactClassification& touched,
                         const Kinematics& now, const WrenchEstimate& estimate,
                         const WrenchEstimate& lately) const;

  std::shared_ptr<const ParallelRobot> robot_;
  ContactClasses classes_;
  std::vector<bool> alike_;  ///< Of each leg.
  Outline platform_;
  ContactLocatorSettings settings_;
  WrenchUncertainty uncertainty_;
};

}  // namespace flinch
