#include "import/clock_rows.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "import/log_file.h"
#include "systems/foundation/median.h"
#include "systems/foundation/setup_error.h"

namespace flinch {
namespace {

/// Rows after which a time that has gone back is a new phase, and not some rows out of order.
constexpr std::size_t rows_of_restart = 8;

double seconds(std::int64_t nanoseconds) { return 1e-9 * static_cast<double>(nanoseconds); }

/// Whether the time begins anew in row `k`, which is before `latest`: the rows that follow stay before it and
/// grow.
bool begins_anew(const std::vector<std::int64_t>& instants, std::size_t k, std::int64_t latest) {
  std::size_t rows = 0, growing = 0;
  std::int64_t last = no_instant;
  for (std::size_t i = k; i < instants.size() && rows < rows_of_restart; ++i) {
    if (instants[i] == no_instant) continue;
    if (instants[i] >= latest) return false;
    ++rows;
    if (last != no_instant && instants[i] > last) ++growing;
    last = instants[i];
  }
  return rows >= 2 && growing * 2 >= rows;
}

/// Whether the row before `k` has leapt ahead by itself: the time of `k` goes on where it was before that.
bool was_ahead(const std::vector<std::int64_t>& instants, const std::vector<std::size_t>& kept,
               std::size_t k) {
  if (kept.size() < 2) return false;
  const std::int64_t before = instants[kept[kept.size() - 2]], leapt = instants[kept.back()];
  return instants[k] > before && leapt - before > 20 * (instants[k] - before);
}

/// The rows whose time grows, from `first` until it begins anew; `next` is the row after.
std::vector<std::size_t> growing_rows(const std::vector<std::int64_t>& instants, std::size_t first,
                                      std::size_t& next, ClockRows& counts) {
  std::vector<std::size_t> kept;
  for (next = first; next < instants.size(); ++next) {
    const std::int64_t now = instants[next];
    if (now == no_instant) {
      ++counts.without_time;
    } else if (kept.empty() || now > instants[kept.back()]) {
      kept.push_back(next);
    } else if (now == instants[kept.back()]) {
      ++counts.repeated;
    } else if (was_ahead(instants, kept, next)) {
      ++counts.out_of_order;
      kept.back() = next;
    } else if (begins_anew(instants, next, instants[kept.back()])) {
      break;
    } else {
      ++counts.out_of_order;
    }
  }
  return kept;
}

/// A period that people set, where `period` is as near to it as `tolerance`.
std::int64_t usual_period(double period, double tolerance) {
  constexpr std::array usual = {100.0,  125.0,  200.0,  240.0,  250.0,  400.0,  500.0,  800.0,
                                1000.0, 1600.0, 2000.0, 4000.0, 5000.0, 8000.0, 10000.0};  // [Hz]
  for (const double rate : usual) {
    if (std::abs(period * rate * 1e-9 - 1.0) <= tolerance) return std::llround(1e9 / rate);
  }
  return std::llround(period);
}

}  // namespace

ClockRows clock_rows(const std::vector<std::int64_t>& instants, std::optional<int> phase) {
  ClockRows rows;
  std::vector<std::size_t> taken;
  for (std::size_t first = 0, next = 0; first < instants.size(); first = next) {
    ClockRows counts;
    std::vector<std::size_t> kept = growing_rows(instants, first, next, counts);
    if (kept.empty()) continue;
    rows.phases.push_back(
        {kept.front(), kept.size(), seconds(instants[kept.back()] - instants[kept.front()])});
    const bool is_wanted =
        phase ? rows.phases.size() == static_cast<std::size_t>(*phase) : kept.size() > taken.size();
    if (!is_wanted) continue;
    taken = std::move(kept);
    rows.phase = rows.phases.size() - 1;
    rows.without_time = counts.without_time;
    rows.repeated = counts.repeated;
    rows.out_of_order = counts.out_of_order;
  }
  if (phase && static_cast<std::size_t>(*phase) > rows.phases.size())
    throw SetupError("there is no phase " + std::to_string(*phase) + "; the time begins " +
                     std::to_string(rows.phases.size()) + " times");
  rows.kept.resize(instants.size());
  rows.instants.reserve(taken.size());
  for (const std::size_t row : taken) {
    rows.kept[row] = true;
    rows.instants.push_back(instants[row]);
  }
  return rows;
}

ClockRate clock_rate(const std::vector<std::int64_t>& instants) {
  ClockRate rate;
  if (instants.size() < 2) return rate;
  // Over ten rows, jitter of the stamps hardly counts, nor that some of them are missing.
  const std::size_t span = std::clamp<std::size_t>(instants.size() / 10, 1, 10);
  std::vector<double> steps;
  steps.reserve(instants.size());
  for (std::size_t k = span; k < instants.size(); ++k)
    steps.push_back(static_cast<double>(instants[k] - instants[k - span]));
  const double typical = median(std::move(steps)) / static_cast<double>(span);
  double squares = 0.0;
  std::size_t whole = 0;
  for (std::size_t k = 1; k < instants.size(); ++k) {
    const double step = static_cast<double>(instants[k] - instants[k - 1]);
    if (step > 1.7 * typical) continue;
    squares += (step - typical) * (step - typical);
    ++whole;
  }
  rate.jitter = whole > 0 ? 1e-9 * std::sqrt(squares / static_cast<double>(whole)) : 0.0;
  rate.period =
      std::max<std::int64_t>(1, usual_period(typical, rate.jitter > 5e-11 * typical ? 0.025 : 0.002));
  for (std::size_t k = 1; k < instants.size(); ++k) {
    const std::int64_t step = instants[k] - instants[k - 1];
    if (step > 3 * rate.period) {
      if (rate.gaps++ == 0) rate.first_gap = seconds(instants[k - 1] - instants[0]);
      rate.longest_gap = std::max(rate.longest_gap, seconds(step));
    } else if (static_cast<double>(step) > 1.7 * typical) {
      rate.bridged += static_cast<std::size_t>(std::lround(static_cast<double>(step) / typical)) - 1;
    }
  }
  return rate;
}

std::vector<std::string> told_rows(const ClockRows& rows, const std::string& clock) {
  std::vector<std::string> told;
  const auto tell = [&](std::size_t count, const std::string& what) {
    if (count > 0)
      told.push_back(std::to_string(count) + (count == 1 ? " row " : " rows ") + what + ": left out");
  };
  tell(rows.without_time, "without a time in '" + clock + "'");
  tell(rows.repeated, "with the time of the row before in '" + clock + "'");
  tell(rows.out_of_order, "out of order in '" + clock + "'");
  if (rows.phases.size() > 1) {
    std::string list;
    for (std::size_t i = 0; i < std::min<std::size_t>(rows.phases.size(), 10); ++i) {
      std::string length = std::to_string(rows.phases[i].seconds);
      list += (i > 0 ? ", " : "") + std::to_string(i + 1) + " (from row " +
              std::to_string(rows.phases[i].first + 1) + ", " + length.substr(0, length.find('.') + 3) +
              " s)";
    }
    told.push_back("the time '" + clock + "' begins " + std::to_string(rows.phases.size()) +
                   " times; taken was phase " + std::to_string(rows.phase + 1) + " of " + list +
                   (rows.phases.size() > 10 ? ", ..." : "") + "; 'phase' chooses another");
  }
  return told;
}

}  // namespace flinch
