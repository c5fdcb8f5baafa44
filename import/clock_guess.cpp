#include "import/clock_guess.h"

#include <cmath>
#include <optional>
#include <utility>

#include "import/clock_rows.h"
#include "import/unit_words.h"
#include "systems/foundation/setup_error.h"

namespace flinch {
namespace {

constexpr double least_rate = 20.0, most_rate = 20'000.0;  // rows a second

/// Rows a second that these instants show; 0: they do not grow.
double rate_of(const std::vector<std::int64_t>& instants) {
  const ClockRows rows = clock_rows(instants);
  if (rows.instants.size() < 3 ||
      rows.instants.size() * 3 < instants.size() / std::max<std::size_t>(rows.phases.size(), 1))
    return 0.0;
  return clock_rate(rows.instants).rate();
}

bool is_usual(double rate) { return least_rate <= rate && rate <= most_rate; }

std::string word_of(ClockUnit unit) {
  switch (unit) {
    case ClockUnit::s:
      return "s";
    case ClockUnit::ms:
      return "ms";
    case ClockUnit::us:
      return "us";
    default:
      return "ns";
  }
}

/// A column that grows as a time does.
struct FoundClock {
  std::size_t column = 0;
  ClockUnit unit = ClockUnit::s;
  bool as_told = true;  ///< the log tells no other unit
};

/// None: it grows by no usual rate in any unit.
std::optional<FoundClock> as_clock(LogFile& log, std::size_t column) {
  const std::optional<UnitWord> told = unit_word(log.columns()[column].unit);
  std::vector<std::pair<ClockUnit, bool>> units;
  if (told && told->quantity == UnitWord::Quantity::time)
    units.emplace_back(static_cast<ClockUnit>(std::llround(told->to_si * 1e9)), true);
  for (const ClockUnit unit : {ClockUnit::s, ClockUnit::ms, ClockUnit::us, ClockUnit::ns})
    units.emplace_back(unit, false);
  for (const auto& [unit, as_told] : units) {
    if (is_usual(rate_of(log.read_instants(column, unit, looked_at_rows))))
      return FoundClock{column, unit, as_told || !told};
  }
  return std::nullopt;
}

ClockGuess told(const LogFile& log, const std::vector<FoundClock>& found) {
  const FoundClock& best = found.front();
  const LogColumn& column = log.columns()[best.column];
  ClockGuess guess{.clock = {column.name, best.unit}, .unit = word_of(best.unit), .reasons = {}};
  if (column.is_clock)
    guess.reasons.push_back("time is '" + column.name + "', dates or times");
  else
    guess.reasons.push_back(
        "time is '" + column.name + "' in " + guess.unit +
        (best.as_told ? "" : ", though it says " + column.unit + ": its steps are no others"));
  const auto in_group = [&](const FoundClock& clock) {
    const std::string& name = log.columns()[clock.column].name;
    return name.substr(name.rfind('/') + 1);
  };
  if (found.size() > 1 && in_group(found[1]) != in_group(best))
    guess.reasons.push_back("'" + log.columns()[found[1].column].name +
                            "' is a time as well; the first was taken");
  return guess;
}

/// Whether two columns are a time in sum: seconds and nanoseconds, or a date and a time of the day.
bool add_to_time(LogFile& log, const LogCandidate& first, const LogCandidate& second, ClockUnit unit) {
  std::vector<std::int64_t> sum = log.read_instants(first.column, ClockUnit::s, looked_at_rows);
  const std::vector<std::int64_t> more = log.read_instants(second.column, unit, looked_at_rows);
  for (std::size_t k = 0; k < sum.size(); ++k)
    sum[k] = sum[k] == no_instant || more[k] == no_instant ? no_instant : sum[k] + more[k];
  const bool is_part =
      second.largest() * static_cast<double>(unit) < 1.0001e9 || log.columns()[second.column].is_clock;
  return is_part && is_usual(rate_of(sum));
}

std::optional<ClockGuess> sum_of_clocks(LogFile& log, const std::vector<const LogCandidate*>& times) {
  const std::vector<LogColumn>& columns = log.columns();
  for (const LogCandidate* first : times) {
    for (const LogCandidate* second : times) {
      if (first == second || columns[first->column].table != columns[second->column].table) continue;
      for (const ClockUnit unit : {ClockUnit::ns, ClockUnit::us}) {
        if (!add_to_time(log, *first, *second, unit)) continue;
        const std::string &one = columns[first->column].name, &other = columns[second->column].name;
        return ClockGuess{.clock = {one, ClockUnit::s, other, unit},
                          .unit = "s",
                          .reasons = {"time is the sum of '" + one + "' and '" + other + "'"}};
      }
    }
  }
  return std::nullopt;
}

}  // namespace

ClockGuess guess_clock(LogFile& log, const std::filesystem::path& name,
                       const std::vector<LogCandidate>& candidates) {
  std::vector<FoundClock> found;
  std::vector<const LogCandidate*> times;
  for (const LogCandidate& candidate : candidates) {
    if (candidate.role.role == ColumnRole::time) times.push_back(&candidate);
    if (candidate.role.role != ColumnRole::time && !log.columns()[candidate.column].is_clock) continue;
    if (const std::optional<FoundClock> clock = as_clock(log, candidate.column)) found.push_back(*clock);
  }
  if (!found.empty()) return told(log, found);
  if (const std::optional<ClockGuess> sum = sum_of_clocks(log, times)) return *sum;
  std::string names;
  for (const LogColumn& each : log.columns()) names += (names.empty() ? "" : ", ") + each.name;
  throw SetupError(name.string() +
                   ": no column is a time that grows by 20 to 20,000 rows a second; columns are: " +
                   names.substr(0, 300) + "; write a mapping that names it");
}

}  // namespace flinch
