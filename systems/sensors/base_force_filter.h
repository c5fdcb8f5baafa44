#pragma once

#include "systems/framework/system.h"
#include "systems/sensors/first_order_low_pass.h"
#include "systems/signals/base_force_reading.h"
#include "systems/signals/sampling.h"
#include "systems/signals/station_status.h"

namespace flinch {

/// Forces at the base joints that lag as drive torques do which are aligned with the velocity, see
/// DriveTorqueMapping: a reading counts as the mean of the interval that it ends. Up to `max_dof` components.
/// Begins anew when the brakes open and after a gap. Not valid where the reading is not, or is not finite.
class BaseForceFilter final : public System {
  struct Memory {
    Time acquired{};
    LowPassMemory force;
  };
  State<Memory> memory_ = state<Memory>("memory");

 public:
  BaseForceFilter(const LowPassSettings& low_pass, const Sampling& sampling);

  InputPort<BaseForceReading> measured = input<BaseForceReading>("measured");
  InputPort<StationStatus> status = input<StationStatus>("status");  ///< for the brakes

 private:
  Intermediate<Memory> next_ = intermediate<&BaseForceFilter::advance>("next", measured, status, memory_);

 public:
  OutputPort<BaseForceReading> filtered = output<&BaseForceFilter::read>("filtered", measured, next_);

 private:
  Update remember_ = keep(memory_, next_);

  void advance(const BaseForceReading& reading, const StationStatus& station, const Memory& memory,
               Memory& next) const;
  void read(const BaseForceReading& reading, const Memory& next, BaseForceReading& result) const;

  FirstOrderLowPass low_pass_;
  Sampling sampling_;
};

}  // namespace flinch
