#pragma once

#include <functional>
#include <string>
#include <vector>

namespace flinch {

struct SpeedLimit;
struct SpeedLimitStudy;

/// The command that repeats the run of a limit that came nearest to a force limit.
using LimitCall = std::function<std::string(const SpeedLimit& limit)>;

/// The map as one HTML page that needs nothing else: the robot from above with the limit speeds of each body
/// over it, all cells as a table, and of each the command that repeats its nearest run. `call`: the command
/// that made it.
std::string speed_limit_page(const SpeedLimitStudy& study, const std::vector<SpeedLimit>& limits,
                             const LimitCall& call_of, const std::string& call);

}  // namespace flinch
