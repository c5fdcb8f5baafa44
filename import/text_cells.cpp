#include "import/text_cells.h"

#include <algorithm>

#include "import/number_text.h"

namespace flinch {
namespace {

bool is_blank(char letter) { return letter == ' ' || letter == '\t'; }

}  // namespace

TextCells::TextCells(std::string_view row, char separator)
    : rest_(separator == ' ' ? trimmed(row) : row), separator_(separator) {}

/// Takes a quoted cell off the rest, with its closing quote.
std::string_view TextCells::quoted() {
  unquoted_.clear();
  std::size_t at = rest_.find('"') + 1;
  for (; at < rest_.size(); ++at) {
    if (rest_[at] != '"') {
      unquoted_ += rest_[at];
    } else if (at + 1 < rest_.size() && rest_[at + 1] == '"') {
      unquoted_ += rest_[at++];
    } else {
      ++at;
      break;
    }
  }
  rest_.remove_prefix(std::min(at, rest_.size()));
  return trimmed(unquoted_);
}

std::optional<std::string_view> TextCells::next() {
  if (ended_) return std::nullopt;
  const std::size_t begin = rest_.find_first_not_of(" \t");
  std::string_view cell;
  const bool is_quoted =
      begin != std::string_view::npos && rest_[begin] == '"' && !(separator_ == '\t' && begin > 0);
  if (is_quoted) cell = quoted();
  const std::size_t end =
      separator_ == ' ' ? std::min(rest_.find(' '), rest_.find('\t')) : rest_.find(separator_);
  ended_ = end == std::string_view::npos;
  if (!is_quoted) cell = trimmed(rest_.substr(0, end));
  if (ended_) return cell;
  rest_.remove_prefix(end + 1);
  while (separator_ == ' ' && !rest_.empty() && is_blank(rest_.front())) rest_.remove_prefix(1);
  return cell;
}

std::vector<std::string> cells_of(std::string_view row, char separator, std::size_t most) {
  std::vector<std::string> all;
  TextCells cells(row, separator);
  for (auto cell = cells.next(); cell && all.size() < most; cell = cells.next()) all.emplace_back(*cell);
  return all;
}

std::size_t count_cells(std::string_view row, char separator) {
  if (separator != ' ' && row.find('"') == std::string_view::npos)
    return 1 + static_cast<std::size_t>(std::count(row.begin(), row.end(), separator));
  std::size_t count = 0;
  TextCells cells(row, separator);
  while (cells.next()) ++count;
  return count;
}

bool has_open_quote(std::string_view row, char separator) {
  if (row.find('"') == std::string_view::npos) return false;
  bool inside = false, at_begin = true;
  for (const char letter : row) {
    if (inside) {
      inside = letter != '"';
    } else if (letter == '"') {
      // A doubled quote ends and begins again; one in the midst of a cell is a letter.
      inside = at_begin;
    } else {
      at_begin = letter == separator || (at_begin && is_blank(letter));
    }
  }
  return inside;
}

}  // namespace flinch
