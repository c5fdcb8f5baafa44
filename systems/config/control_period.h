#pragma once

#include <chrono>

namespace flinch {

class ConfigReader;

/// Bounds of the time from one tick of a control path to the next.
inline constexpr std::chrono::nanoseconds shortest_control_period = std::chrono::microseconds(250);
inline constexpr std::chrono::nanoseconds longest_control_period = std::chrono::milliseconds(4);
inline constexpr std::chrono::nanoseconds default_control_period = std::chrono::milliseconds(1);

/// The key `control_period_us` of robot and scenario files: within these bounds.
void read_control_period(ConfigReader& reader, std::chrono::nanoseconds& period);

}  // namespace flinch
