#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "import/log_file.h"

namespace flinch {

/// A date, a time of the day or both, in the forms in which programs write them: ISO 8601 with its offset
/// from UTC, "2026-01-31 12:00:01,250", "31.01.2026", "01/31/2026 1:00:00 PM", "12:00:01.25". Nanoseconds
/// since 1970, of a time alone since midnight; none where the text is nothing of that.
std::optional<std::int64_t> clock_text(std::string_view text);

/// A decimal number of that unit as nanoseconds, without a detour over a binary fraction; none where it is no
/// number or too large.
std::optional<std::int64_t> decimal_instant(std::string_view text, char decimal, ClockUnit unit);

}  // namespace flinch
