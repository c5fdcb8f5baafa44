#pragma once

#include <memory>

#include "systems/contact/contact_locator.h"
#include "systems/contact/link_particles.h"
#include "systems/contact/wrench_uncertainty.h"
#include "systems/framework/system.h"
#include "systems/robot/link_contact.h"
#include "systems/robot/outline.h"
#include "systems/robot/parallel_robot.h"
#include "systems/signals/contact_classes.h"
#include "systems/signals/contact_location.h"
#include "systems/signals/contact_phase.h"
#include "systems/signals/particle_cloud.h"
#include "systems/signals/wrench_estimate.h"

namespace flinch {

/// Says where the classified second link is touched by a particle filter (`LinkParticles`), which begins
/// anew, from the closed form, with every contact and whenever another link is classified; and on the
/// platform, where the wrench tells the place at once, in closed form (`locate_on_platform`). Of other bodies
/// it knows no place.
class ParticleLocator final : public System {
 public:
  struct Memory {
    LinkParticles particles;
    int body = -1;  ///< BodyId::index() of the link that they are of
    ContactLocation location;
  };

 private:
  State<Memory> memory_;

 public:
  /// `closed_form`: of the place on the platform, and of what counts as located. Throws SetupError for
  /// settings that are not positive.
  ParticleLocator(std::shared_ptr<const ParallelRobot> robot, const LinkParticleSettings& settings,
                  const ContactLocatorSettings& closed_form, const WrenchUncertainty& uncertainty,
                  std::uint64_t seed);

  InputPort<ContactPhase> phase = input<ContactPhase>("phase");
  InputPort<ContactClassification> classification = input<ContactClassification>("classification");
  InputPort<Kinematics> kinematics = input<Kinematics>("kinematics");
  InputPort<WrenchEstimate> wrench = input<WrenchEstimate>("wrench");
  InputPort<WrenchEstimate> change = input<WrenchEstimate>("change");  ///< of late, as `WrenchTrend` tells

 private:
  Intermediate<Memory> next_;

 public:
  OutputPort<ContactLocation> location;
  OutputPort<ParticleCloud> cloud;

 private:
  void advance(Time now, const ContactPhase& contact, const ContactClassification& touched,
               const Kinematics& at, const WrenchEstimate& estimate, const WrenchEstimate& lately,
               const Memory& memory, Memory& next) const;
  ContactLocation locate_on_link2(const LinkContactMap& link, const LinkParticleEstimate& mean,
                                  const PlatformVector& felt, const PlatformMatrix& noise,
                                  const PlatformMatrix& errors) const;
  ContactLocation read(const Memory& next, const WrenchEstimate& estimate) const;
  void show(const Memory& next, ParticleCloud& shown) const;

  std::shared_ptr<const ParallelRobot> robot_;
  ContactClasses classes_;
  Outline platform_;
  LinkParticleSettings settings_;
  ContactLocatorSettings closed_form_;
  WrenchUncertainty uncertainty_;
};

}  // namespace flinch
