#include "import/computed_columns.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <set>

namespace flinch {
namespace {

constexpr std::size_t least_returns = 20;   // of the drives to positions at which they were before
constexpr std::size_t least_numbers = 10;   // that a column has there
constexpr double rounding = 1e-5;           // of the range of a column, in a text of six digits
constexpr std::size_t most_on_line = 2000;  // rows that a line is laid through, evenly from all

bool is_same(double one, double other) { return one == other || (std::isnan(one) && std::isnan(other)); }

/// Rows at which all drives have the same positions, some of them with others in between.
std::vector<std::vector<std::size_t>> returns_of(std::span<const ColumnNumbers> drives) {
  if (drives.empty()) return {};
  std::vector<std::size_t> order;
  for (std::size_t k = 0; k < drives.front().values.size(); ++k) {
    const bool is_whole = std::all_of(drives.begin(), drives.end(), [&](const ColumnNumbers& drive) {
      return k < drive.values.size() && std::isfinite(drive.values[k]);
    });
    if (is_whole) order.push_back(k);
  }
  const auto compared = [&](std::size_t a, std::size_t b) {
    for (const ColumnNumbers& drive : drives) {
      if (drive.values[a] != drive.values[b]) return drive.values[a] < drive.values[b] ? -1 : 1;
    }
    return 0;
  };
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return compared(a, b) < 0; });
  std::vector<std::vector<std::size_t>> returns;
  for (auto begin = order.begin(); begin != order.end();) {
    const auto end =
        std::find_if(begin, order.end(), [&](std::size_t row) { return compared(*begin, row) != 0; });
    const auto rows = static_cast<std::size_t>(end - begin);
    if (*(end - 1) - *begin >= rows) returns.emplace_back(begin, end);
    begin = end;
  }
  return returns;
}

bool is_function(const ColumnNumbers& candidate, const std::vector<std::vector<std::size_t>>& returns) {
  if (returns.size() < least_returns) return false;
  std::set<double> numbers;
  for (const std::vector<std::size_t>& rows : returns) {
    if (rows.back() >= candidate.values.size()) return false;
    const double first = candidate.values[rows.front()];
    const bool is_one = std::all_of(rows.begin(), rows.end(),
                                    [&](std::size_t row) { return is_same(candidate.values[row], first); });
    if (!is_one) return false;
    if (std::isfinite(first)) numbers.insert(first);
  }
  return numbers.size() >= least_numbers;
}

/// Whether all of `y` lies on one straight line over `x`, which is not level.
bool is_on_line(const std::vector<double>& x, const std::vector<double>& y) {
  double count = 0.0, mean_x = 0.0, mean_y = 0.0, xx = 0.0, xy = 0.0;
  double least = std::numeric_limits<double>::infinity(), most = -least;
  std::set<double> numbers;
  const std::size_t rows = std::min(x.size(), y.size()), stride = 1 + rows / most_on_line;
  const auto is_there = [&](std::size_t k) { return std::isfinite(x[k]) && std::isfinite(y[k]); };
  for (std::size_t k = 0; k < rows; k += stride) {
    if (!is_there(k)) continue;
    count += 1.0;
    const double dx = x[k] - mean_x, dy = y[k] - mean_y;
    mean_x += dx / count;
    mean_y += dy / count;
    xx += dx * (x[k] - mean_x);
    xy += dx * (y[k] - mean_y);
    least = std::min(least, y[k]);
    most = std::max(most, y[k]);
    if (numbers.size() < least_numbers) numbers.insert(y[k]);
  }
  if (count < static_cast<double>(least_returns) || numbers.size() < least_numbers || !(xx > 0.0))
    return false;
  const double slope = xy / xx;
  if (slope == 0.0) return false;
  for (std::size_t k = 0; k < rows; k += stride) {
    if (is_there(k) && std::abs(y[k] - mean_y - slope * (x[k] - mean_x)) > rounding * (most - least))
      return false;
  }
  return true;
}

/// The difference quotient from `before` rows before each row to `after` rows after it.
std::vector<double> rate_of(const std::vector<double>& values, std::span<const double> seconds,
                            std::size_t before, std::size_t after) {
  std::vector<double> rates(values.size(), std::numeric_limits<double>::quiet_NaN());
  for (std::size_t k = before; k + after < std::min(values.size(), seconds.size()); ++k) {
    const double time = seconds[k + after] - seconds[k - before];
    if (time > 0.0) rates[k] = (values[k + after] - values[k - before]) / time;
  }
  return rates;
}

/// A column, and its rate as programs compute it.
struct Source {
  const ColumnNumbers* column;
  std::array<std::vector<double>, 3> rates;

  Source(const ColumnNumbers& of, std::span<const double> seconds)
      : column(&of),
        rates{rate_of(of.values, seconds, 1, 0), rate_of(of.values, seconds, 0, 1),
              rate_of(of.values, seconds, 1, 1)} {}

  /// How `candidate` follows from it; none: it does not.
  std::optional<ComputedColumn::How> how(const ColumnNumbers& candidate) const {
    if (is_on_line(column->values, candidate.values)) return ComputedColumn::How::multiple;
    for (const std::vector<double>& rate : rates) {
      if (is_on_line(rate, candidate.values)) return ComputedColumn::How::rate;
    }
    return std::nullopt;
  }
};

}  // namespace

std::string ComputedColumn::words() const {
  std::string names;
  for (const std::string& each : from) names += (names.empty() ? "'" : ", '") + each + "'";
  const char* const relation = how == How::function   ? "a function of "
                               : how == How::multiple ? "a multiple of "
                                                      : "the rate of ";
  return relation + names;
}

std::vector<ComputedColumn> computed_columns(std::span<const ColumnNumbers> drives,
                                             std::span<const ColumnNumbers> others,
                                             std::span<const ColumnNumbers> candidates,
                                             std::span<const double> seconds) {
  const std::vector<std::vector<std::size_t>> returns = returns_of(drives);
  std::vector<Source> sources;
  for (const ColumnNumbers& drive : drives) sources.emplace_back(drive, seconds);
  for (const ColumnNumbers& other : others) sources.emplace_back(other, seconds);
  std::vector<ComputedColumn> computed;
  for (const ColumnNumbers& candidate : candidates) {
    std::optional<ComputedColumn> found;
    for (const Source& source : sources) {
      if (found || source.column->name == candidate.name) continue;
      if (const auto how = source.how(candidate))
        found = ComputedColumn{candidate.name, {source.column->name}, *how};
    }
    if (!found && is_function(candidate, returns)) {
      found = ComputedColumn{candidate.name, {}, ComputedColumn::How::function};
      for (const ColumnNumbers& drive : drives) found->from.push_back(drive.name);
    }
    if (found) computed.push_back(std::move(*found));
  }
  return computed;
}

}  // namespace flinch
