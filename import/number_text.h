#pragma once

#include <optional>
#include <string_view>

namespace flinch {

/// A finite number with a decimal point or comma; none where the text is none. What a program writes for true
/// and false is 1 and 0.
std::optional<double> number_text(std::string_view text, char decimal);

/// Whether a cell says that there is no value: empty, "nan", "NA", "null", "-", an infinity.
bool says_no_value(std::string_view text);

/// Without blanks around it.
std::string_view trimmed(std::string_view text);

}  // namespace flinch
