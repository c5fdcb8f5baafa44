#pragma once

#include <memory>

#include "systems/estimators/momentum_observer.h"
#include "systems/framework/system.h"
#include "systems/robot/leg_bases.h"
#include "systems/signals/base_force_estimate.h"
#include "systems/signals/base_force_reading.h"
#include "systems/signals/drive_torque.h"
#include "systems/signals/platform_motion.h"
#include "systems/signals/sampling.h"

namespace flinch {

struct BaseForceObserverSettings {
  double gain = 100.0;  ///< k_o of all components [1/s]
  Sampling sampling{};
  /// How long a velocity that has just begun still adapts: five time constants of the 30 Hz filter.
  Time input_settling_time = 27ms;
};

/// Momentum observer of what contacts leave at the base joints, by `LegBases`:
/// solved by FirstOrderMomentumMethod as that of the wrench, with forces that lag as the
/// drive torques do, between samples the mean of both. Begins anew where samples are missing for longer than
/// the longest hold, and as long as brakes are closed, which add torques that nobody measures.
class BaseForceObserver final : public System {
 public:
  /// Throws SetupError for more than `max_dof` components, or a gain that is not positive.
  BaseForceObserver(std::shared_ptr<const LegBases> bases, const BaseForceObserverSettings& settings);

 private:
  /// Of the last sample.
  struct Memory {
    bool started = false;
    Time acquired{}, arrived{}, begun{};  ///< the latter two are ticks
    PlatformVector p, known;              ///< of the base joints
    FirstOrderMomentumMethod::Memory method;
  };

  std::shared_ptr<const LegBases> bases_;
  BaseForceObserverSettings settings_;
  FirstOrderMomentumMethod method_;
  State<Memory> memory_ = state<Memory>("memory");

 public:
  InputPort<PlatformMotion> platform = input<PlatformMotion>("platform");
  InputPort<Kinematics> kinematics = input<Kinematics>("kinematics");
  InputPort<DriveTorque> torque = input<DriveTorque>("torque");
  InputPort<BaseForceReading> forces = input<BaseForceReading>("forces");

 private:
  Intermediate<Memory> next_ =
      intermediate<&BaseForceObserver::advance>("next", platform, kinematics, torque, forces, memory_, clock);

 public:
  OutputPort<BaseForceEstimate> estimate = output<&BaseForceObserver::read>("estimate", next_, clock);

 private:
  Update remember_ = keep(memory_, next_);

  void advance(const PlatformMotion& motion, const Kinematics& at, const DriveTorque& drives,
               const BaseForceReading& reading, const Memory& memory, Time now, Memory& next) const;
  void read(const Memory& next, Time now, BaseForceEstimate& result) const;
  bool is_usable(const PlatformMotion& motion, const Kinematics& at, const DriveTorque& drives,
                 const BaseForceReading& reading) const;
};

}  // namespace flinch
