#include "apps/flinch/shell_word.h"

#include <algorithm>
#include <cctype>
#include <string_view>

namespace flinch {

std::string shell_word(const std::string& text) {
  constexpr std::string_view plain = "_@%+=:,./-";
  const bool is_plain = !text.empty() && std::all_of(text.begin(), text.end(), [plain](unsigned char letter) {
    return std::isalnum(letter) != 0 || plain.find(static_cast<char>(letter)) != std::string_view::npos;
  });
  if (is_plain) return text;
  std::string word = "'";
  for (const char letter : text) word += letter == '\'' ? std::string("'\\''") : std::string(1, letter);
  return word + "'";
}

}  // namespace flinch
