#pragma once

#include <string>
#include <string_view>

namespace flinch {

/// Text that a terminal shows and does not obey. Control characters but line feed and tab, and characters
/// that change the direction of writing, become "\u001b", as JSON writes them; bytes that are no UTF-8 become
/// "\xff".
std::string visible_text(std::string_view text);

}  // namespace flinch
