#pragma once

#include <memory>

#include "systems/contact/link_particles.h"
#include "systems/contact/wrench_uncertainty.h"
#include "systems/framework/system.h"
#include "systems/robot/parallel_robot.h"
#include "systems/signals/contact_classes.h"
#include "systems/signals/contact_location.h"
#include "systems/signals/contact_phase.h"
#include "systems/signals/particle_cloud.h"
#include "systems/signals/wrench_estimate.h"

namespace flinch {

/// Says where the classified link is touched by a particle filter (`LinkParticles`), which begins anew, from
/// the closed form, with every contact and whenever another link is classified. Only second links tell: of
/// other bodies it knows no place.
class ParticleLocator final : public System {
 public:
  struct Memory {
    LinkParticles particles;
    int body = -1;  ///< BodyId::index() of the link that they are of
    LinkParticleEstimate estimate;
    LinkContactMap link;
  };

 private:
  State<Memory> memory_;

 public:
  /// Throws SetupError for settings that are not positive.
  ParticleLocator(std::shared_ptr<const ParallelRobot> robot, const LinkParticleSettings& settings,
                  const WrenchUncertainty& uncertainty, std::uint64_t seed);

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
  ContactLocation read(const Memory& next, const WrenchEstimate& estimate) const;
  void show(const Memory& next, ParticleCloud& shown) const;

  std::shared_ptr<const ParallelRobot> robot_;
  ContactClasses classes_;
  LinkParticleSettings settings_;
  WrenchUncertainty uncertainty_;
};

}  // namespace flinch
