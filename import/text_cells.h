#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace flinch {

/// How the numbers of a row are written. A separator ' ' stands for blanks and tabs, as many as there are.
struct CellStyle {
  char separator = ',';
  char decimal = '.';
};

/// The cells of a row, one after the other, with quotes as RFC 4180 has them, without blanks around them: a
/// row may have millions that nobody wants.
class TextCells {
 public:
  TextCells(std::string_view row, char separator);

  /// The next cell; none after the last. It stands in the row, or in this object until the next call.
  std::optional<std::string_view> next();

 private:
  std::string_view quoted();

  std::string_view rest_;
  char separator_;
  bool ended_ = false;
  std::string unquoted_;
};

/// All cells of a row, at most so many.
std::vector<std::string> cells_of(std::string_view row, char separator, std::size_t most);

/// How many there are.
std::size_t count_cells(std::string_view row, char separator);

/// Whether a quote of the row is still open at its end, so that the next line goes on with it.
bool has_open_quote(std::string_view row, char separator);

}  // namespace flinch
