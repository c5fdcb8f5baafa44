#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "import/text_cells.h"

namespace flinch {

/// How a text holds a table, as far as its first lines tell: what the cells are separated by, where the rows
/// begin, and what stands above them.
struct TextLayout {
  CellStyle style;
  std::size_t first_line = 1;      ///< of the rows, counted from 1
  std::size_t cells = 0;           ///< of a row
  std::vector<std::string> names;  ///< of the columns; without a header their numbers, from 1
  std::vector<std::string> units;  ///< of each column, "" where none is told
  std::vector<bool> is_clock;      ///< whether the cells of a column are dates or times of the day
  bool has_header = false;
  double bytes_a_row = 1.0;            ///< about
  std::vector<std::string> header{};   ///< the rows that name the columns, which may come again
  std::vector<std::string> remarks{};  ///< what is worth telling
};

/// Lines that a layout is told by.
struct TextHead {
  std::vector<std::string> lines;
  bool is_whole = false;  ///< there are no more
};

TextHead head_of(const std::filesystem::path& file);

/// Throws SetupError naming the file where the lines are no table.
TextLayout layout_of(const TextHead& head, const std::string& file);

}  // namespace flinch
