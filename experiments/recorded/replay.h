#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "systems/framework/recording.h"

namespace flinch {

struct Scenario;

/// What a control path makes of recorded readings.
struct Replay {
  Recording recording;                 ///< the new one, with what others had measured of the old run
  std::vector<std::string> differing;  ///< signals that are not the same, bit for bit; empty: all are
};

/// Runs the control path of `scenario` on the readings, the operator's buttons and the timing of ticks of
/// `recorded`, as fast as it can. The torques have no effect. Throws SetupError when readings are missing,
/// and as add_contact_control().
Replay replay(const Scenario& scenario, const Recording& recorded,
              const std::map<std::string, std::string>& provenance = {},
              const std::function<void(double share)>& progress = {});

}  // namespace flinch
