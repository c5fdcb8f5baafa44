#include "import/number_text.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

namespace flinch {
namespace {

constexpr std::size_t longest_number = 64;

bool equals(std::string_view text, std::string_view lower) {
  return std::equal(text.begin(), text.end(), lower.begin(), lower.end(),
                    [](char a, char b) { return (a >= 'A' && a <= 'Z' ? a + 32 : a) == b; });
}

}  // namespace

std::optional<double> number_text(std::string_view text, char decimal) {
  if (text.starts_with('+')) text.remove_prefix(1);
  if (text.empty() || text.size() > longest_number) return std::nullopt;
  std::array<char, longest_number> copy;
  if (decimal != '.') {
    if (text.find('.') != std::string_view::npos) return std::nullopt;
    std::replace_copy(text.begin(), text.end(), copy.begin(), decimal, '.');
    text = {copy.data(), text.size()};
  }
  double value = 0.0;
  const auto [rest, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error == std::errc{} && rest == text.data() + text.size() && std::isfinite(value)) return value;
  if (equals(text, "true")) return 1.0;
  if (equals(text, "false")) return 0.0;
  return std::nullopt;
}

bool says_no_value(std::string_view text) {
  constexpr std::array words = {"",       "nan",     "na",       "n/a",       "#n/a",      "null",
                                "none",   "-",       "--",       "?",         "inf",       "+inf",
                                "-inf",   "-nan",    "+nan",     "nan(ind)",  "-nan(ind)", "1.#qnan",
                                "1.#inf", "-1.#ind", "infinity", "-infinity", "nil"};
  return std::any_of(words.begin(), words.end(), [&](const char* word) { return equals(text, word); });
}

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view blank = " \t\r\n\f\v";
  const std::size_t begin = text.find_first_not_of(blank);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(blank) + 1 - begin);
}

}  // namespace flinch
