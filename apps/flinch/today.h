#pragma once

#include <string>

namespace flinch {

/// The date in Greenwich, "2026-11-22".
std::string today();

}  // namespace flinch
