#include "import/text_log.h"

#include <algorithm>
#include <cmath>

#include "import/number_text.h"
#include "import/text_lines.h"
#include "import/time_text.h"
#include "systems/foundation/setup_error.h"

namespace flinch {
namespace {

constexpr std::size_t most_shown = 100;  // letters of a cell

/// Rows that are not as the others, and what became of them.
struct StrangeRows {
  std::size_t rows = 0;
  std::size_t too_short = 0;
  std::size_t too_long = 0;
  std::size_t headers = 0;
  std::size_t first_line = 0;

  void note(std::size_t& count, std::size_t line) {
    if (too_short + too_long == 0) first_line = line;
    ++count;
  }
};

std::string counted(std::size_t count, const std::string& what) {
  return std::to_string(count) + " " + what + (count == 1 ? "" : "s");
}

}  // namespace

TextLog::TextLog(const std::filesystem::path& file) {
  file_ = file;
  const TextHead head = head_of(file);
  layout_ = layout_of(head, file.string());
  remarks_ = layout_.remarks;
  const std::size_t rows = expected_rows(all_rows, 1);
  for (std::size_t i = 0; i < layout_.cells; ++i)
    columns_.push_back({layout_.names[i], layout_.units[i], "", rows, false, layout_.is_clock[i]});
  number_equal_names(columns_);
}

std::size_t TextLog::expected_rows(std::size_t most_rows, std::size_t columns) const {
  const auto bytes = static_cast<double>(std::filesystem::file_size(file_));
  const double rows = std::min(bytes / layout_.bytes_a_row * 1.02 + 10.0,
                               1.0 + bytes / (2.0 * static_cast<double>(std::max<std::size_t>(columns, 1))));
  return std::min(most_rows, static_cast<std::size_t>(rows));
}

void TextLog::visit(std::span<const std::size_t> wanted, std::size_t most_rows,
                    const std::function<void()>& next_row, const Take& take) {
  std::vector<std::size_t> order(wanted.size());  // of the wanted columns, as they stand in a row
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return wanted[a] < wanted[b]; });
  TextLines lines(file_);
  StrangeRows strange;
  std::string line, more;
  std::size_t number = 0;
  while (strange.rows < most_rows && lines.next(line)) {
    const std::size_t at = ++number;
    for (int joined = 0; joined < 20 && has_open_quote(line, layout_.style.separator); ++joined) {
      if (!lines.next(more)) break;
      ++number;
      line += "\n" + more;
    }
    if (at < layout_.first_line || trimmed(line).empty()) continue;
    const std::size_t cells = count_cells(line, layout_.style.separator);
    if (cells != layout_.cells) {
      const std::string_view text = trimmed(line);
      if (text.starts_with('#') || text.starts_with('%') || text.starts_with("//")) continue;
      if (cells < layout_.cells && !lines.was_ended()) {
        if (!told_rows_)
          remarks_.push_back("line " + std::to_string(at) + ", the last one, is cut: it was left out");
        break;
      }
      strange.note(cells < layout_.cells ? strange.too_short : strange.too_long, at);
      if (cells > layout_.cells) continue;
      if (strange.too_short > 1000 && strange.too_short * 2 > strange.rows)
        throw SetupError(file_.string() + ":" + std::to_string(at) + ": rows have fewer cells than the " +
                         std::to_string(layout_.cells) + " of the first ones");
    } else if (std::find(layout_.header.begin(), layout_.header.end(), line) != layout_.header.end()) {
      ++strange.headers;
      continue;
    }
    next_row();
    ++strange.rows;
    TextCells row(line, layout_.style.separator);
    std::size_t column = 0;
    std::optional<std::string_view> cell = row.next();
    for (const std::size_t i : order) {
      for (; cell && column < wanted[i]; ++column) cell = row.next();
      take(i, cell.value_or(std::string_view()), at);
    }
  }
  if (told_rows_) return;
  told_rows_ = true;
  const std::string first = ", first in line " + std::to_string(strange.first_line);
  if (strange.too_short > 0)
    remarks_.push_back(counted(strange.too_short, "row") + " shorter than the others" + first +
                       ": what is missing there is not valid");
  if (strange.too_long > 0)
    remarks_.push_back(counted(strange.too_long, "row") + " with more cells than names" + first +
                       ": left out");
  if (strange.headers > 0)
    remarks_.push_back("the header comes again " + counted(strange.headers, "time") + ": left out");
  if (lines.zeros() > 0 && lines.encoding() == TextEncoding::utf8)
    remarks_.push_back(counted(lines.zeros(), "byte") + " of zero were passed over");
}

std::vector<std::vector<double>> TextLog::read(std::span<const std::size_t> wanted, std::size_t most_rows) {
  const double none = std::nan("");
  std::vector<std::vector<double>> numbers(wanted.size());
  std::vector<std::string> first_text(wanted.size());
  std::vector<std::size_t> texts(wanted.size());
  for (std::vector<double>& column : numbers) column.reserve(expected_rows(most_rows, wanted.size()));
  visit(
      wanted, most_rows,
      [&] {
        for (std::vector<double>& column : numbers) column.push_back(none);
      },
      [&](std::size_t i, std::string_view cell, std::size_t line) {
        if (const auto value = number_text(cell, layout_.style.decimal)) {
          numbers[i].back() = *value;
        } else if (!says_no_value(cell)) {
          if (texts[i]++ == 0)
            first_text[i] =
                "line " + std::to_string(line) + ": '" + std::string(cell.substr(0, most_shown)) + "'";
        }
      });
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    if (texts[i] == 0 || columns_[wanted[i]].is_clock) continue;
    remarks_.push_back("column '" + columns_[wanted[i]].name + "': " + counted(texts[i], "cell") +
                       " are no number and so not valid, the first in " + first_text[i]);
  }
  return numbers;
}

std::vector<std::int64_t> TextLog::read_instants(std::size_t column, ClockUnit unit, std::size_t most_rows) {
  std::vector<std::int64_t> instants;
  instants.reserve(expected_rows(most_rows, 1));
  const bool is_clock = columns_[column].is_clock;
  visit(
      std::array{column}, most_rows, [&] { instants.push_back(no_instant); },
      [&](std::size_t, std::string_view cell, std::size_t) {
        const auto instant = is_clock ? clock_text(cell) : decimal_instant(cell, layout_.style.decimal, unit);
        if (instant) instants.back() = *instant;
      });
  return instants;
}

}  // namespace flinch
