#include "systems/sensors/base_force_filter.h"

namespace flinch {
namespace {

bool is_usable(const BaseForceReading& reading) {
  return reading.valid && reading.force_in_base.size() <= max_dof && reading.force_in_base.allFinite();
}

}  // namespace

BaseForceFilter::BaseForceFilter(const LowPassSettings& low_pass, const Sampling& sampling)
    : low_pass_(low_pass), sampling_(sampling) {}

void BaseForceFilter::advance(const BaseForceReading& reading, const StationStatus& station,
                              const Memory& memory, Memory& next) const {
  next = Memory();
  if (station.valid && station.braked) return;
  next = memory;
  const bool is_new = !memory.force.started || reading.acquired > memory.acquired;
  if (!is_usable(reading) || !is_new) return;
  const bool continued = memory.force.started && memory.force.output.size() == reading.force_in_base.size() &&
                         !sampling_.interrupted(memory.acquired, reading.acquired);
  const double interval = to_seconds(continued ? reading.acquired - memory.acquired : sampling_.period);
  next.acquired = reading.acquired;
  next.force = low_pass_.next(continued ? memory.force : LowPassMemory(), reading.force_in_base, interval);
}

void BaseForceFilter::read(const BaseForceReading& reading, const Memory& next,
                           BaseForceReading& result) const {
  result = reading;
  result.valid = is_usable(reading);
  if (result.valid && next.force.started) result.force_in_base = next.force.output;
}

}  // namespace flinch
