#include "apps/flinch/today.h"

#include <fmt/chrono.h>
#include <fmt/core.h>

#include <ctime>

namespace flinch {

std::string today() { return fmt::format("{:%Y-%m-%d}", fmt::gmtime(std::time(nullptr))); }

std::string moment_in_names() { return fmt::format("{:%Y-%m-%d_%H-%M-%S}", fmt::gmtime(std::time(nullptr))); }

}  // namespace flinch
