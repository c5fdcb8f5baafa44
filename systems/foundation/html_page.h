#pragma once

#include <string>
#include <string_view>

namespace flinch {

/// A text that means nothing in HTML, neither between tags nor in a quoted attribute.
std::string escaped(std::string_view text);

/// A page as far as its body: it loads nothing, runs no script and follows the colour scheme of who looks.
/// `title` is any text, `style` CSS of our own.
std::string page_head(std::string_view title, std::string_view style);

}  // namespace flinch
