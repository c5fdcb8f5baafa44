#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace flinch {

/// An instant that a log does not tell.
inline constexpr std::int64_t no_instant = std::numeric_limits<std::int64_t>::min();

/// A column that a log offers.
struct LogColumn {
  std::string name;       ///< Unique in the log: of several "i" they are "i#1", "i#2".
  std::string unit{};     ///< As the log writes it, "deg"; "" where it says none.
  std::string table{};    ///< Columns of one table have their rows in common.
  std::size_t rows = 0;   ///< Of the table; of a text as far as it was looked at.
  bool is_alias = false;  ///< Another name of a column that is there as well.
  bool is_clock = false;  ///< The cells are dates or times of the day.
};

/// Nanoseconds in one unit of a column of time.
enum class ClockUnit : std::int64_t { ns = 1, us = 1'000, ms = 1'000'000, s = 1'000'000'000 };

/// A log of another program: named columns of numbers, whatever the format of the file. Reading appends to
/// the remarks what was wrong with the file and did not keep it from being read.
class LogFile {
 public:
  static constexpr std::size_t all_rows = std::numeric_limits<std::size_t>::max();

  LogFile() = default;
  LogFile(const LogFile&) = delete;
  LogFile& operator=(const LogFile&) = delete;
  virtual ~LogFile();

  const std::vector<LogColumn>& columns() const { return columns_; }
  const std::vector<std::string>& remarks() const { return remarks_; }

  /// Index of the column of that name, or of that number, counted from 1, where none is called so. Throws
  /// SetupError where there is none, naming the nearest, and where several have the name.
  virtual std::size_t find(const std::string& name) const;

  /// The numbers of these columns, of the first rows only if so wanted; NaN where there is none.
  virtual std::vector<std::vector<double>> read(std::span<const std::size_t> wanted,
                                                std::size_t most_rows = all_rows) = 0;
  /// The instants of a column, exact where its cells are [ns]; `no_instant` where there is none.
  virtual std::vector<std::int64_t> read_instants(std::size_t column, ClockUnit unit,
                                                  std::size_t most_rows = all_rows) = 0;

 protected:
  /// Throws SetupError, with the remarks, where no column was found. `what`: that the file lacks.
  void throw_if_empty(const std::string& what) const;
  /// The instants that the numbers of a column are.
  std::vector<std::int64_t> instants_of_numbers(std::size_t column, ClockUnit unit, std::size_t most_rows);

  std::vector<LogColumn> columns_;
  std::vector<std::string> remarks_;
  std::filesystem::path file_;
};

/// Opens a log of any format that flinch reads, told by the content of the file. Throws SetupError naming the
/// file and what is wrong with it.
std::unique_ptr<LogFile> open_log(const std::filesystem::path& file);

/// Instants of numbers in that unit; `no_instant` where one is not finite or too large.
std::int64_t instant_of(double value, ClockUnit unit);

/// Makes names unique: "i", "i" are "i#1", "i#2".
void number_equal_names(std::vector<LogColumn>& columns);

}  // namespace flinch
