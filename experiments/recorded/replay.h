#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "diagrams/requested_fault.h"
#include "systems/framework/recording.h"

namespace flinch {

class Diagram;
struct Scenario;

/// What a control path makes of recorded readings.
struct Replay {
  Recording recording;                 ///< the new one, with what others had measured of the old run
  std::vector<std::string> differing;  ///< signals that are not the same, bit for bit; empty: all are
};

/// The control path of `scenario` behind a station that plays `recorded`, for who steps it by himself.
std::unique_ptr<Diagram> build_replay(const Scenario& scenario, const Recording& recorded,
                                      const std::vector<RequestedFault>& faults = {});

/// Runs the control path of `scenario` on the readings, the operator's buttons and the timing of ticks of
/// `recorded`, as fast as it can. The torques have no effect. `faults` are put on top of the readings. Throws
/// SetupError when readings are missing, for faults that a recording cannot have, and as
/// add_contact_control().
Replay replay(const Scenario& scenario, const Recording& recorded,
              const std::map<std::string, std::string>& provenance = {},
              const std::function<void(double share)>& progress = {},
              const std::vector<RequestedFault>& faults = {});

}  // namespace flinch
