#pragma once

#include <string>

namespace flinch {

/// JSON that can stand inside a script element: without a "<" that could end the element or open a comment.
std::string inside_script(const std::string& json);

}  // namespace flinch
