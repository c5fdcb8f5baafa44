#include "apps/flinch/fault_options.h"

#include "systems/foundation/setup_error.h"

namespace flinch {

void add_faults(const std::vector<std::string>& options, const ParallelRobot& robot,
                std::vector<RequestedFault>& faults) {
  std::vector<std::string> found;
  for (const std::string& option : options) {
    try {
      faults.push_back(parse_fault(option, robot));
    } catch (const SetupError& error) {
      for (const std::string& each : error.problems()) found.push_back("--fault: " + each);
    }
  }
  throw_if_any(std::move(found));
}

}  // namespace flinch
