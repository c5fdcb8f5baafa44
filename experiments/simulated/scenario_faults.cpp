#include "experiments/simulated/scenario_faults.h"

#include "systems/config/config_reader.h"
#include "systems/foundation/setup_error.h"

namespace flinch {
namespace {

/// What stands in an entry; nothing where it is no fault of this robot.
std::optional<RequestedFault> read_fault(ConfigReader& entry, const ParallelRobot& robot) {
  RequestedFault fault;
  std::string signal, kind;
  double size = 0.0;
  entry.required().text("signal", signal);
  entry.required().word("kind", kind, fault_kinds());
  entry.required().duration("time", fault.begin, between(0.0, 3600.0));
  const bool sized = entry.has("size");
  if (sized) entry.number("size", unit::none, size);
  if (!entry.good()) return std::nullopt;
  if (sized) fault.size = size;
  try {
    set_signal(fault, signal);
    fault.kind = fault_kind(kind);
    throw_if_any(problems(fault, robot));
  } catch (const SetupError& error) {
    for (const std::string& each : error.problems()) entry.problem("", each);
  }
  return fault;
}

}  // namespace

std::vector<RequestedFault> read_faults(ConfigReader& file, const ParallelRobot& robot) {
  std::vector<RequestedFault> faults;
  for (ConfigReader& entry : file.sections("faults")) {
    if (const auto fault = read_fault(entry, robot)) faults.push_back(*fault);
  }
  return faults;
}

}  // namespace flinch
