#include "calibration/hdf5_table.h"

#include <charconv>
#include <cmath>
#include <map>
#include <mutex>

#include "systems/foundation/setup_error.h"
#include "systems/framework/hdf5_object.h"

namespace flinch {
namespace {

constexpr std::size_t most_problems = 10;

/// "/log/current[2]": data set and column.
struct ColumnName {
  std::string set;
  std::size_t column = 0;
};

ColumnName parsed(const std::string& name) {
  const std::size_t open = name.rfind('[');
  if (open == std::string::npos || name.back() != ']') return {name, 0};
  ColumnName column{name.substr(0, open), 0};
  const char* const end = name.data() + name.size() - 1;
  const auto [rest, error] = std::from_chars(name.data() + open + 1, end, column.column);
  if (error != std::errc{} || rest != end)
    throw SetupError("'" + name + "' must end in a number in brackets");
  return column;
}

/// Data sets of a file, each read once.
class Sets {
 public:
  explicit Sets(const std::filesystem::path& file) : file_(internal::open_hdf5_file(file)) {}

  const internal::ForeignTable& operator[](const std::string& name) {
    const auto known = sets_.find(name);
    if (known != sets_.end()) return known->second;
    return sets_.emplace(name, internal::read_foreign_table(file_, name)).first->second;
  }

 private:
  internal::Hdf5Object file_;
  std::map<std::string, internal::ForeignTable> sets_;
};

}  // namespace

CsvTable read_hdf5_table(const std::filesystem::path& file, const std::vector<std::string>& wanted) {
  const std::lock_guard lock(internal::hdf5_mutex());
  std::vector<std::string> problems;
  CsvTable table{.names = wanted, .values = {}, .first_row = 1};
  try {
    Sets sets(file);
    for (std::size_t i = 0; i < wanted.size() && problems.size() < most_problems; ++i) {
      const std::string place = file.string() + ": column '" + wanted[i] + "'";
      try {
        const ColumnName name = parsed(wanted[i]);
        const internal::ForeignTable& set = sets[name.set];
        const auto rows = static_cast<Eigen::Index>(set.rows), column = static_cast<Eigen::Index>(i);
        if (i == 0) table.values.setZero(rows, static_cast<Eigen::Index>(wanted.size()));
        if (name.column >= set.columns) {
          problems.push_back(place + " is not there; the data set has " + std::to_string(set.columns) +
                             " columns, counted from 0");
        } else if (rows != table.values.rows()) {
          problems.push_back(place + " has " + std::to_string(rows) + " rows, and '" + wanted.front() +
                             "' has " + std::to_string(table.values.rows()));
        } else {
          for (Eigen::Index k = 0; k < rows && problems.size() < most_problems; ++k) {
            const double value = set.numbers[static_cast<std::size_t>(k) * set.columns + name.column];
            table.values(k, column) = value;
            if (!std::isfinite(value))
              problems.push_back(file.string() + ":" + std::to_string(k + 1) + ": column '" + wanted[i] +
                                 "' is no finite number");
          }
        }
      } catch (const SetupError& error) {
        for (const std::string& problem : error.problems()) problems.push_back(place + ": " + problem);
      }
    }
  } catch (const SetupError& error) {
    for (const std::string& problem : error.problems()) problems.push_back(file.string() + ": " + problem);
  }
  throw_if_any(std::move(problems));
  return table;
}

}  // namespace flinch
