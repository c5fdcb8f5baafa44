#include "experiments/bus/opening_monitor.h"

#include <fmt/core.h>

#include <bit>

#include "experiments/verdict/fault_words.h"

namespace flinch {
namespace {

GateFault first_of(FaultMask faults) {
  return faults == 0 ? GateFault::none : static_cast<GateFault>(std::countr_zero(faults));
}

}  // namespace

bool OpeningMonitor::sees_it_closed(const GateStatus& gate, Time now) noexcept {
  has_opened_ = has_opened_ || gate.passes();
  waited_ = now;
  cause_ = first_of(gate.faults);
  const bool settles = gate.faults == fault_bit(GateFault::contact_unmonitored);
  return !has_opened_ && now > (settles ? until_settled : longest);
}

std::string OpeningMonitor::sentence() const {
  return fmt::format("the torque gate did not open within {:.0f} s: {}", to_seconds(waited_),
                     description_of(cause_, "no fault is present"));
}

}  // namespace flinch
