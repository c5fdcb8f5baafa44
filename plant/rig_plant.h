#pragma once

#include "plant/applied_wrench.h"
#include "plant/contact_history.h"
#include "plant/contact_truth.h"
#include "plant/drive_action.h"
#include "plant/obstacle_truth.h"
#include "plant/plant_truth.h"
#include "plant/rig_dynamics.h"
#include "systems/framework/system.h"
#include "systems/signals/platform_motion.h"

namespace flinch {

/// The simulated rig: robot and obstacles. Its outputs at a tick are the truth at that instant, under the
/// torque that acted until then.
class RigPlant final : public System {
  std::shared_ptr<const RigDynamics> dynamics_;
  Time tick_;
  State<RigState> state_ = state<RigState>("motion", dynamics_->initial_state());
  /// After this tick.
  State<RigStep> step_ = state<RigStep>("step", dynamics_->initial_step());
  /// Until the tick before.
  State<ContactHistory> history_ = state<ContactHistory>("contacts");

 public:
  /// `tick` is the time between ticks of the diagram, or a multiple of it; build() refuses anything else.
  /// Throws SetupError.
  explicit RigPlant(const RigSettings& settings, Time tick = 1ms);

  InputPort<DriveAction> drives = input<DriveAction>("drives");  ///< Must be held between ticks.
  InputPort<AppliedWrench> applied = input<AppliedWrench>("applied");

  OutputPort<RigSnapshot> snapshot = output<&RigPlant::look>("snapshot", state_, step_, drives, applied);
  OutputPort<PlantTruth> truth = output<&RigPlant::tell_truth>("truth", clock, snapshot, drives);
  OutputPort<ObstacleTruth> obstacles = output<&RigPlant::tell_obstacles>("obstacles", clock, snapshot);
  OutputPort<PlatformMotion> platform = output<&RigPlant::tell_platform>("platform", truth);

 private:
  Intermediate<ContactHistory> history_now_ =
      intermediate<&RigPlant::follow>("history", clock, snapshot, history_);

 public:
  OutputPort<ContactTruth> contact = output<&RigPlant::tell_contact>("contact", snapshot, history_now_);

  const RigDynamics& dynamics() const { return *dynamics_; }

 private:
  void move(const RigState& motion, const DriveAction& acting, const AppliedWrench& wrench,
            const RigStep& step, RigState& rates) const;
  void look(const RigState& motion, const RigStep& step, const DriveAction& acting,
            const AppliedWrench& wrench, RigSnapshot& out) const;
  void look_ahead(Time now, const RigState& motion, const RigSnapshot& rig, const RigStep& before,
                  RigStep& after) const;

  void tell_truth(Time now, const RigSnapshot& rig, const DriveAction& acting, PlantTruth& out) const;
  void tell_obstacles(Time now, const RigSnapshot& rig, ObstacleTruth& out) const;
  void tell_platform(const PlantTruth& robot, PlatformMotion& out) const;
  void follow(Time now, const RigSnapshot& rig, const ContactHistory& before, ContactHistory& after) const;
  void tell_contact(const RigSnapshot& rig, const ContactHistory& history, ContactTruth& out) const;

  Update remember_ = keep(history_, history_now_);
  Update look_ahead_ = update<&RigPlant::look_ahead>(Every{tick_}, step_, clock, state_, snapshot, step_);
  Derivative move_ = derivative<&RigPlant::move>(state_, state_, drives, applied, step_);
};

}  // namespace flinch
