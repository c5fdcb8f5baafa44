#pragma once

#include <string>

namespace flinch {

/// The date in Greenwich, "2026-11-22".
std::string today();

/// Date and time in Greenwich as names of folders have them, "2026-11-22_09-41-07": in their order.
std::string moment_in_names();

}  // namespace flinch
