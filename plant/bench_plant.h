#pragma once

#include "plant/applied_wrench.h"
#include "plant/bench_dynamics.h"
#include "plant/contact_history.h"
#include "plant/contact_truth.h"
#include "plant/drive_action.h"
#include "plant/obstacle_truth.h"
#include "plant/plant_truth.h"
#include "systems/framework/system.h"
#include "systems/signals/platform_motion.h"

namespace flinch {

/// The simulated bench: robot and obstacles. Its outputs at a tick are the truth at that instant, under the
/// torque that acted until then.
class BenchPlant final : public System {
  std::shared_ptr<const BenchDynamics> dynamics_;
  Time tick_;
  State<BenchState> state_ = state<BenchState>("motion", dynamics_->initial_state());
  /// After this tick.
  State<BenchStep> step_ = state<BenchStep>("step", dynamics_->initial_step());
  /// Until the tick before.
  State<ContactHistory> history_ = state<ContactHistory>("contacts");

 public:
  /// `tick` is the time between ticks of the diagram, or a multiple of it; build() refuses anything else.
  /// Throws SetupError.
  explicit BenchPlant(const BenchSettings& settings, Time tick = 1ms);

  InputPort<DriveAction> drives = input<DriveAction>("drives");  ///< Must be held between ticks.
  InputPort<AppliedWrench> applied = input<AppliedWrench>("applied");

  OutputPort<BenchSnapshot> snapshot = output<&BenchPlant::look>("snapshot", state_, step_, drives, applied);
  OutputPort<PlantTruth> truth = output<&BenchPlant::tell_truth>("truth", clock, snapshot, drives);
  OutputPort<ObstacleTruth> obstacles = output<&BenchPlant::tell_obstacles>("obstacles", clock, snapshot);
  OutputPort<PlatformMotion> platform = output<&BenchPlant::tell_platform>("platform", truth);

 private:
  Intermediate<ContactHistory> history_now_ =
      intermediate<&BenchPlant::follow>("history", clock, snapshot, history_);

 public:
  OutputPort<ContactTruth> contact = output<&BenchPlant::tell_contact>("contact", snapshot, history_now_);

  const BenchDynamics& dynamics() const { return *dynamics_; }

 private:
  void move(const BenchState& motion, const DriveAction& acting, const AppliedWrench& wrench,
            const BenchStep& step, BenchState& rates) const;
  void look(const BenchState& motion, const BenchStep& step, const DriveAction& acting,
            const AppliedWrench& wrench, BenchSnapshot& out) const;
  void look_ahead(Time now, const BenchState& motion, const BenchSnapshot& bench, const BenchStep& before,
                  BenchStep& after) const;

  void tell_truth(Time now, const BenchSnapshot& bench, const DriveAction& acting, PlantTruth& out) const;
  void tell_obstacles(Time now, const BenchSnapshot& bench, ObstacleTruth& out) const;
  void tell_platform(const PlantTruth& robot, PlatformMotion& out) const;
  void follow(Time now, const BenchSnapshot& bench, const ContactHistory& before,
              ContactHistory& after) const;
  void tell_contact(const BenchSnapshot& bench, const ContactHistory& history, ContactTruth& out) const;

  Update remember_ = keep(history_, history_now_);
  Update look_ahead_ = update<&BenchPlant::look_ahead>(Every{tick_}, step_, clock, state_, snapshot, step_);
  Derivative move_ = derivative<&BenchPlant::move>(state_, state_, drives, applied, step_);
};

}  // namespace flinch
