#include "import/text_layout.h"

#include <algorithm>
#include <array>
#include <map>

#include "import/number_text.h"
#include "import/text_lines.h"
#include "import/time_text.h"
#include "import/unit_words.h"
#include "systems/foundation/setup_error.h"

namespace flinch {
namespace {

constexpr std::size_t most_lines = 400;
constexpr std::size_t most_bytes = 1U << 21U;
constexpr std::size_t most_cells = 100'000;

/// What the cells of a row are.
struct RowKind {
  std::size_t cells = 0;
  std::size_t values = 0;  ///< numbers, dates and times
  std::size_t texts = 0;
  std::size_t empty = 0;  ///< or saying that there is no value
};

RowKind kind_of(std::string_view line, const CellStyle& style) {
  RowKind kind;
  TextCells cells(line, style.separator);
  for (auto cell = cells.next(); cell && kind.cells < most_cells; cell = cells.next()) {
    ++kind.cells;
    if (says_no_value(*cell)) {
      ++kind.empty;
    } else if (number_text(*cell, style.decimal) || clock_text(*cell)) {
      ++kind.values;
    } else {
      ++kind.texts;
    }
  }
  return kind;
}

bool is_comment(std::string_view line) {
  const std::string_view text = trimmed(line);
  return text.starts_with('#') || text.starts_with('%') || text.starts_with("//") || text.starts_with('!');
}

std::string_view without_comment_sign(std::string_view line) {
  const std::string_view text = trimmed(line);
  const std::size_t begin = text.find_first_not_of("#%/!");
  return begin == std::string_view::npos ? std::string_view() : trimmed(text.substr(begin));
}

/// The count of cells that most rows with numbers have, at least two; 0: there are none.
std::size_t usual_cells(const std::vector<RowKind>& kinds) {
  std::map<std::size_t, std::size_t> count;
  for (const RowKind& kind : kinds) {
    if (kind.cells >= 2 && kind.values > 0 && kind.values >= kind.texts) ++count[kind.cells];
  }
  std::size_t best = 0;
  for (const auto& [cells, rows] : count) {
    if (best == 0 || rows >= count[best]) best = cells;
  }
  return best;
}

/// How well a style explains the lines: values that stand in rows of equal length.
double score(const std::vector<RowKind>& kinds, std::size_t cells) {
  double sum = 0.0;
  for (const RowKind& kind : kinds) {
    if (kind.cells == cells && kind.values > 0)
      sum += static_cast<double>(kind.values) - static_cast<double>(kind.texts) +
             0.01 * static_cast<double>(kind.empty);
  }
  return sum;
}

std::vector<RowKind> kinds_of(const std::vector<std::string>& lines, const CellStyle& style) {
  std::vector<RowKind> kinds;
  for (const std::string& line : lines) {
    kinds.push_back(trimmed(line).empty() || is_comment(line) ? RowKind() : kind_of(line, style));
  }
  return kinds;
}

/// A row of the table, or one that could be.
bool is_row(const RowKind& kind, std::size_t cells) {
  return kind.cells == cells && kind.values > 0 && kind.values >= kind.texts;
}

/// The numbers of columns in the first line, as a program writes that has no names: 0, 1, 2, ... or 1, 2, 3,
/// ... above rows that are no whole numbers alone.
bool counts_columns(const std::vector<std::string>& lines, std::size_t at, const CellStyle& style) {
  if (at > 0) return false;
  const bool has_fractions = std::any_of(lines.begin() + 1, lines.end(), [&](const std::string& line) {
    return line.find(style.decimal) != std::string::npos && style.decimal != style.separator;
  });
  if (!has_fractions) return false;
  const std::string& line = lines[at];
  const std::vector<std::string> cells = cells_of(line, style.separator, most_cells);
  std::size_t first = 0, next = 0;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (i == 0 && cells[i].empty()) continue;
    if (next == 0 && cells[i] != "0" && cells[i] != "1") return false;
    if (next == 0) first = cells[i] == "0" ? 0 : 1;
    if (cells[i] != std::to_string(first + next++)) return false;
  }
  return next >= 3;
}

/// Names of a header whose cells are separated otherwise than those of the rows.
std::vector<std::string> header_cells(const std::string& line, const TextLayout& layout) {
  const std::string text(is_comment(line) ? without_comment_sign(line) : std::string_view(line));
  std::vector<std::string> cells = cells_of(text, layout.style.separator, most_cells);
  if (cells.size() == layout.cells) return cells;
  for (const char other : {'\t', ',', ';', '|', ' '}) {
    if (count_cells(text, other) == layout.cells) return cells_of(text, other, most_cells);
  }
  // Columns that are lined up: two blanks or more.
  std::vector<std::string> wide;
  for (std::size_t begin = text.find_first_not_of(" \t"); begin != std::string::npos;) {
    const std::size_t end = std::min(text.find("  ", begin), text.find('\t', begin));
    wide.emplace_back(trimmed(std::string_view(text).substr(begin, end - begin)));
    begin = end == std::string::npos ? end : text.find_first_not_of(" \t", end);
  }
  return wide.size() == layout.cells ? wide : cells;
}

bool all_empty(const std::vector<std::string>& cells) {
  return std::all_of(cells.begin(), cells.end(), [](const std::string& cell) { return cell.empty(); });
}

bool are_units(const std::vector<std::string>& cells) {
  std::size_t units = 0, filled = 0;
  for (const std::string& cell : cells) {
    filled += cell.empty() ? 0 : 1;
    units += !cell.empty() && is_unit_word(cell) ? 1 : 0;
  }
  return units > 0 && units * 10 >= filled * 6;
}

/// The header rows right above the first row of the table, from top to bottom.
std::vector<std::vector<std::string>> header_rows(const std::vector<std::string>& lines,
                                                  const TextLayout& layout, std::size_t first,
                                                  std::size_t& first_header) {
  std::vector<std::vector<std::string>> rows;
  first_header = first;
  for (std::size_t k = first; k-- > 0 && rows.size() < 6;) {
    if (trimmed(lines[k]).empty()) {
      if (rows.empty()) continue;
      break;
    }
    const std::vector<std::string> cells = header_cells(lines[k], layout);
    const std::size_t texts =
        static_cast<std::size_t>(std::count_if(cells.begin(), cells.end(), [&](const std::string& cell) {
          return !cell.empty() && !number_text(cell, layout.style.decimal) && !clock_text(cell);
        }));
    const bool fits = cells.size() == layout.cells ||
                      (rows.empty() && (cells.size() + 1 == layout.cells || cells.size() > layout.cells));
    const bool numbered = rows.empty() && counts_columns(lines, k, layout.style);
    if (!fits || all_empty(cells) || (texts * 2 < cells.size() && texts < 2 && !numbered)) break;
    if (is_comment(lines[k]) && (cells.size() != layout.cells || texts != cells.size())) break;
    // Above a row of names stand groups of them, which are fewer or the same again.
    if (!rows.empty() && !are_units(rows.front()) && is_comment(lines[k])) break;
    rows.insert(rows.begin(), cells);
    first_header = k;
  }
  return rows;
}

/// "robot.x" of a row of groups above a row of names; a group goes on until the next begins.
std::vector<std::string> joined_names(const std::vector<std::vector<std::string>>& rows, std::size_t cells) {
  std::vector<std::string> names(cells);
  for (const std::vector<std::string>& row : rows) {
    const bool is_last = &row == &rows.back();
    std::string group;
    for (std::size_t i = 0; i < cells; ++i) {
      const std::string cell = i < row.size() ? row[i] : "";
      if (!cell.empty()) group = cell;
      const std::string part = is_last ? cell : group;
      if (part.empty() || part == names[i]) continue;
      names[i] += (names[i].empty() ? "" : ".") + part;
    }
  }
  return names;
}

/// What stands between the names: R leaves the name of the rows out, others end each row with a separator.
void fit_header(std::vector<std::vector<std::string>>& rows, const std::vector<std::string>& lines,
                std::size_t first, TextLayout& layout, const std::string& file) {
  const std::size_t names = rows.back().size();
  if (names == layout.cells) return;
  std::vector<std::string> sample;
  for (std::size_t k = first; k < lines.size(); ++k) {
    const std::vector<std::string> cells = cells_of(lines[k], layout.style.separator, most_cells);
    if (cells.size() == layout.cells) sample.push_back(names < layout.cells ? cells[names] : "");
  }
  const auto empty = [](const std::string& cell) { return cell.empty(); };
  if (names + 1 == layout.cells && std::all_of(sample.begin(), sample.end(), empty)) {
    for (std::vector<std::string>& row : rows) row.resize(layout.cells);
    return;
  }
  std::size_t counted = 0, k = 0;
  for (std::size_t line = first; line < lines.size(); ++line) {
    const std::vector<std::string> cells = cells_of(lines[line], layout.style.separator, most_cells);
    if (cells.size() != layout.cells) continue;
    ++k;
    counted += cells[0] == std::to_string(k) || cells[0] == std::to_string(k - 1) ||
                       !number_text(cells[0], layout.style.decimal)
                   ? 1
                   : 0;
  }
  if (names + 1 == layout.cells && counted == k) {
    const std::vector<std::string> row_name = {"row"};
    for (std::vector<std::string>& row : rows) row.insert(row.begin(), row_name.begin(), row_name.end());
    layout.remarks.push_back(
        "the header has a name less than the rows have cells: the first cell of a row "
        "is taken for its name, as R writes it");
    return;
  }
  throw SetupError(file + ":" + std::to_string(first) + ": the header has " + std::to_string(names) +
                   " names, and the rows below it have " + std::to_string(layout.cells) +
                   " cells; which name belongs to which cell cannot be told");
}

void name_columns(const std::vector<std::string>& lines, std::size_t first, TextLayout& layout,
                  const std::string& file) {
  std::size_t first_header = first;
  std::vector<std::vector<std::string>> rows = header_rows(lines, layout, first, first_header);
  layout.names.resize(layout.cells);
  layout.units.resize(layout.cells);
  layout.has_header = !rows.empty();
  for (std::size_t k = first_header; k < first; ++k) layout.header.push_back(lines[k]);
  if (rows.size() > 1 && are_units(rows.back())) {
    layout.units = rows.back();
    layout.units.resize(layout.cells);
    rows.pop_back();
  } else if (rows.size() > 1 && are_units(rows.front())) {
    layout.units = rows.front();
    layout.units.resize(layout.cells);
    rows.erase(rows.begin());
  }
  if (!rows.empty()) {
    fit_header(rows, lines, first, layout, file);
    layout.names = joined_names(rows, layout.cells);
  }
  for (std::size_t i = 0; i < layout.cells; ++i) {
    if (layout.names[i].empty())
      layout.names[i] = rows.empty() ? std::to_string(i + 1) : "column " + std::to_string(i + 1);
    if (layout.units[i].empty()) layout.units[i] = unit_in_name(layout.names[i]);
  }
  if (first_header > 0) {
    const auto told = std::count_if(lines.begin(), lines.begin() + static_cast<std::ptrdiff_t>(first_header),
                                    [](const std::string& line) { return !trimmed(line).empty(); });
    if (told > 0) layout.remarks.push_back(std::to_string(told) + " lines above the table were passed over");
  }
  if (rows.empty())
    layout.remarks.emplace_back("there is no header: columns are named by their numbers, from 1");
}

/// Which columns hold dates or times of the day, by the first rows.
void find_clocks(const std::vector<std::string>& lines, std::size_t first, TextLayout& layout) {
  std::vector<std::size_t> clocks(layout.cells), others(layout.cells);
  for (std::size_t k = first; k < lines.size() && k < first + 50; ++k) {
    const std::vector<std::string> cells = cells_of(lines[k], layout.style.separator, most_cells);
    for (std::size_t i = 0; i < std::min(cells.size(), layout.cells); ++i) {
      if (number_text(cells[i], layout.style.decimal)) {
        ++others[i];
      } else if (clock_text(cells[i])) {
        ++clocks[i];
      }
    }
  }
  for (std::size_t i = 0; i < layout.cells; ++i) layout.is_clock.push_back(clocks[i] > others[i]);
}

}  // namespace

TextHead head_of(const std::filesystem::path& file) {
  TextHead head;
  TextLines lines(file);
  std::string line;
  std::size_t bytes = 0;
  while (head.lines.size() < most_lines && bytes < most_bytes) {
    if (!lines.next(line)) {
      head.is_whole = true;
      break;
    }
    for (int joined = 0; joined < 20 && has_open_quote(line, ','); ++joined) {
      std::string more;
      if (!lines.next(more)) break;
      line += "\n" + more;
    }
    bytes += line.size() + 1;
    head.lines.push_back(line);
  }
  return head;
}

TextLayout layout_of(const TextHead& head, const std::string& file) {
  TextLayout layout;
  double best = 0.0;
  std::vector<RowKind> kinds;
  for (const CellStyle style :
       {CellStyle{',', '.'}, CellStyle{';', '.'}, CellStyle{'\t', '.'}, CellStyle{'|', '.'},
        CellStyle{' ', '.'}, CellStyle{';', ','}, CellStyle{'\t', ','}, CellStyle{'|', ','},
        CellStyle{' ', ','}, CellStyle{',', ','}}) {
    const std::vector<RowKind> tried = kinds_of(head.lines, style);
    const std::size_t cells = usual_cells(tried);
    const double now = cells > 0 ? score(tried, cells) : 0.0;
    if (now <= best) continue;
    best = now;
    kinds = tried;
    layout.style = style;
    layout.cells = cells;
  }
  if (layout.cells == 0)
    throw SetupError(file +
                     ": has no table: no rows of two numbers or more, separated by commas, "
                     "semicolons, tabs, strokes or blanks");
  std::size_t first = 0;
  const auto starts = [&](std::size_t k) {
    std::size_t next = k + 1;
    while (next < kinds.size() && kinds[next].cells == 0) ++next;
    return is_row(kinds[k], layout.cells) && !counts_columns(head.lines, k, layout.style) &&
           (next >= kinds.size() || is_row(kinds[next], layout.cells) || kinds[next].values > 0);
  };
  while (first < kinds.size() && !starts(first)) ++first;
  if (first == kinds.size()) throw SetupError(file + ": has no table: no two rows of it are alike");
  name_columns(head.lines, first, layout, file);
  find_clocks(head.lines, first, layout);
  // Lines of a cell with line ends in it are several.
  layout.first_line = 1;
  std::size_t bytes = 0;
  for (std::size_t k = 0; k < head.lines.size(); ++k) {
    if (k < first)
      layout.first_line +=
          1 + static_cast<std::size_t>(std::count(head.lines[k].begin(), head.lines[k].end(), '\n'));
    else
      bytes += head.lines[k].size() + 1;
  }
  layout.bytes_a_row = static_cast<double>(bytes) / static_cast<double>(head.lines.size() - first);
  return layout;
}

}  // namespace flinch
