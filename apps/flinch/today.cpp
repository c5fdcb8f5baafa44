#include "apps/flinch/today.h"

#include <fmt/chrono.h>
#include <fmt/core.h>

#include <ctime>

namespace flinch {

std::string today() { return fmt::format("{:%Y-%m-%d}", fmt::gmtime(std::time(nullptr))); }

}  // namespace flinch
