#pragma once

#include <memory>

#include "systems/framework/system.h"
#include "systems/robot/impedance_damping.h"
#include "systems/robot/parallel_robot.h"
#include "systems/signals/platform_reference.h"
#include "systems/signals/torque_command.h"

namespace flinch {

struct ImpedanceSettings {
  /// Diagonal of K_d, none negative [N/m, Nm/rad]; empty: 2000 N/m and 85 Nm/rad. [ICRA23] II-C
  PlatformVector stiffness;
  PlatformVector damping_ratio;  ///< xi of each direction, positive; empty: 1, which is critical
  bool compensate_friction = true;
};

/// `settings` with what they leave empty filled in for `space`.
ImpedanceSettings complete(ImpedanceSettings settings, const ConfigurationSpace& space);

/// What the impedance asks of the platform.
struct ImpedanceWrench {
  bool valid = false;
  DampingDesign damping = DampingDesign::none;  ///< by which D_d was found
  PlatformVector error;                         ///< e = x_d (-) x
  PlatformVector wrench_in_base;                ///< F_a

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("valid", "", self.valid);
    visit("damping", "", self.damping);
    visit("error", "<displacement>", self.error, "base");
    visit("wrench_in_base", "<wrench>", self.wrench_in_base, "base");
  }
};

/// Cartesian impedance control, [SafePR] (7)-(10), [ICRA23] (9)-(11):
///   F_a = C_x dx + g_x + F_fr,x + M_x ddx_d + K_d e + D_d de,   tau = J_x,qa^T F_a,   e = x_d - x,
/// with the damping D_d designed at every tick for M_x. In closed loop M_x dde + D_d de + K_d e = -F_ext.
/// On spaces with rotation about three axes, error, reference and spring are those of `PoseGuidance` and
/// `spring_wrench`.
///
/// Where reference, kinematics or dynamics are not valid, so are wrench and torque.
class ImpedanceController final : public System {
 public:
  /// Throws SetupError for settings of the wrong size or outside their range.
  ImpedanceController(std::shared_ptr<const ParallelRobot> robot, const ImpedanceSettings& settings);

  InputPort<PlatformReference> reference = input<PlatformReference>("reference");
  InputPort<Kinematics> kinematics = input<Kinematics>("kinematics");
  InputPort<Dynamics> dynamics = input<Dynamics>("dynamics");

  OutputPort<ImpedanceWrench> wrench =
      output<&ImpedanceController::impede>("wrench", reference, kinematics, dynamics);
  OutputPort<TorqueCommand> torque = output<&ImpedanceController::drive>("torque", clock, wrench, kinematics);

 private:
  void impede(const PlatformReference& desired, const Kinematics& at, const Dynamics& model,
              ImpedanceWrench& result) const;
  void drive(Time now, const ImpedanceWrench& wanted, const Kinematics& at, TorqueCommand& command) const;
  bool can_follow(const PlatformReference& desired) const;

  std::shared_ptr<const ParallelRobot> robot_;
  ImpedanceSettings settings_;
  PlatformMatrix K_d_;
};

}  // namespace flinch
