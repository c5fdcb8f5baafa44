#include "experiments/comparison/comparison.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "systems/foundation/setup_error.h"

namespace flinch {
namespace {

using internal::Number;

bool is_same(const Field& one, const Field& other) {
  return one.name == other.name && one.kind == other.kind && one.capacity == other.capacity &&
         one.resizable == other.resizable;
}

bool have_same_fields(const Signal& one, const Signal& other) {
  return std::equal(one.layout.fields.begin(), one.layout.fields.end(), other.layout.fields.begin(),
                    other.layout.fields.end(), is_same);
}

/// The first of `count` rows that differs; `count` where none does.
std::size_t first_differing_row(const std::vector<Number>& one, const std::vector<Number>& other,
                                std::size_t count, std::size_t numbers) {
  if (std::memcmp(one.data(), other.data(), count * numbers * sizeof(Number)) == 0) return count;
  std::size_t row = 0;
  while (std::memcmp(one.data() + row * numbers, other.data() + row * numbers, numbers * sizeof(Number)) == 0)
    ++row;
  return row;
}

/// The first of the samples that are not of one time; the shorter length where all are.
std::size_t first_other_time(const Recording& one, const Recording& other) {
  const auto [here, there] =
      std::mismatch(one.time_ns.begin(), one.time_ns.end(), other.time_ns.begin(), other.time_ns.end());
  return static_cast<std::size_t>(here - one.time_ns.begin());
}

// ---------------------------------------------------------------- correlation

constexpr double coarse = 0.01;  // [s] between the samples that are compared first

/// Velocities of the drives, from sample to sample, `period` apart.
struct DriveVelocities {
  double start = 0.0;
  std::vector<std::vector<double>> of_drive;

  std::size_t size() const { return of_drive.front().size(); }
};

DriveVelocities velocities_of(const Recording& recording, double period) {
  if (recording.find("joints") == nullptr || recording.samples() < 3)
    throw SetupError("there are no angles of drives that could be correlated");
  DriveVelocities result{1e-9 * static_cast<double>(recording.time_ns.front()), {}};
  const double length = 1e-9 * static_cast<double>(recording.time_ns.back()) - result.start;
  const auto count = static_cast<std::size_t>(length / period);
  int capacity = 1;
  for (const Field& field : recording.signal("joints").layout.fields) {
    if (field.name == "active") capacity = field.capacity;
  }
  for (int drive = 0; drive < capacity; ++drive) {
    const std::vector<double> angles = recording.column("joints", "active", drive);
    if (std::isnan(angles.front()) && std::isnan(angles.back())) break;  // it has no more drives
    std::vector<double>& rates = result.of_drive.emplace_back(count);
    std::size_t k = 0;
    double before = angles.front();
    for (std::size_t i = 0; i < count; ++i) {
      const double time = result.start + period * static_cast<double>(i + 1);
      while (k + 1 < angles.size() && 1e-9 * static_cast<double>(recording.time_ns[k]) < time - 1e-9) ++k;
      const double rate = (angles[k] - before) / period;
      rates[i] = std::isfinite(rate) ? rate : 0.0;
      before = angles[k];
    }
  }
  if (result.of_drive.empty()) throw SetupError("there are no angles of drives that could be correlated");
  return result;
}

/// Of the samples in which both are there, with `other` taken `lag` samples later; none for too few, or none
/// that move.
std::optional<double> correlation(const DriveVelocities& one, const DriveVelocities& other, std::int64_t lag,
                                  std::size_t least) {
  const auto first = std::max<std::int64_t>(0, -lag);
  const auto last =
      std::min(static_cast<std::int64_t>(one.size()), static_cast<std::int64_t>(other.size()) - lag);
  if (last - first < static_cast<std::int64_t>(least)) return std::nullopt;
  double product = 0.0, here = 0.0, there = 0.0;
  for (std::size_t drive = 0; drive < one.of_drive.size(); ++drive) {
    const double* const a = one.of_drive[drive].data();
    const double* const b = other.of_drive[drive].data() + lag;
    for (std::int64_t i = first; i < last; ++i) {
      product += a[i] * b[i];
      here += a[i] * a[i];
      there += b[i] * b[i];
    }
  }
  if (here <= 0.0 || there <= 0.0) return std::nullopt;
  return product / std::sqrt(here * there);
}

/// The lag in [from, to] with the largest correlation.
std::optional<std::int64_t> best_lag(const DriveVelocities& one, const DriveVelocities& other,
                                     std::int64_t from, std::int64_t to) {
  const std::size_t least = std::max<std::size_t>(1, std::min(one.size(), other.size()) / 3);
  std::optional<std::int64_t> best;
  double largest = 0.0;
  for (std::int64_t lag = from; lag <= to; ++lag) {
    const auto found = correlation(one, other, lag, least);
    if (!found || *found <= largest) continue;
    largest = *found;
    best = lag;
  }
  return best;
}

/// How much later `other` is, by samples `period` apart, about `guess`, or anywhere.
double delay_at(const Recording& one, const Recording& other, double period, std::optional<double> guess) {
  const DriveVelocities a = velocities_of(one, period), b = velocities_of(other, period);
  if (a.of_drive.size() != b.of_drive.size()) throw SetupError("they have other drives");
  const double offset = b.start - a.start;
  std::int64_t from = -static_cast<std::int64_t>(a.size()), to = static_cast<std::int64_t>(b.size());
  if (guess) {
    const auto lag = std::llround((*guess - offset) / period);
    const auto width = std::llround(2.0 * coarse / period);
    from = lag - width;
    to = lag + width;
  }
  const auto lag = best_lag(a, b, from, to);
  if (!lag) throw SetupError("a motion to correlate is not in both");
  return offset + period * static_cast<double>(*lag);
}

}  // namespace

std::optional<FirstDifference> first_difference(const Recording& one, const Recording& other) {
  const std::size_t common = first_other_time(one, other);
  std::vector<const Signal*> signals;
  for (const Signal& signal : one.signals) {
    const Signal* const same = other.find(signal.path);
    if (same != nullptr && have_same_fields(signal, *same)) signals.push_back(&signal);
  }
  std::vector<Number> rows, other_rows;
  for (std::size_t begin = 0; begin < common; begin += Recording::block) {
    std::size_t count = std::min(Recording::block, common - begin);
    std::optional<FirstDifference> found;
    for (const Signal* signal : signals) {
      const std::size_t numbers = signal->layout.numbers;
      rows.resize(count * numbers);
      other_rows.resize(count * numbers);
      one.read_rows(*signal, begin, count, rows.data());
      other.read_rows(*other.find(signal->path), begin, count, other_rows.data());
      const std::size_t row = first_differing_row(rows, other_rows, count, numbers);
      if (row == count) continue;
      if (!found || begin + row < found->tick) {
        found = FirstDifference{
            begin + row, 1e-9 * static_cast<double>(one.time_ns[begin + row]), signal->path, {}};
        count = row + 1;  // what comes later is of no interest
      } else {
        found->others.push_back(signal->path);
      }
    }
    if (found) return found;
  }
  if (common == one.samples() && common == other.samples()) return std::nullopt;
  const Recording& longer = common < one.samples() ? one : other;
  return FirstDifference{common, 1e-9 * static_cast<double>(longer.time_ns[common]), "time_ns", {}};
}

std::vector<std::string> signals_of_one(const Recording& one, const Recording& other) {
  std::vector<std::string> paths;
  for (const Signal& signal : one.signals) {
    const Signal* const same = other.find(signal.path);
    if (same == nullptr || !have_same_fields(signal, *same)) paths.push_back(signal.path);
  }
  for (const Signal& signal : other.signals) {
    if (one.find(signal.path) == nullptr) paths.push_back(signal.path);
  }
  return paths;
}

std::vector<SettingDifference> differing_settings(const std::vector<std::vector<ReadValue>>& lists) {
  std::vector<SettingDifference> settings;
  std::map<std::string, std::size_t> places;
  for (std::size_t i = 0; i < lists.size(); ++i) {
    for (const ReadValue& value : lists[i]) {
      const auto [place, is_new] = places.try_emplace(value.key, settings.size());
      if (is_new)
        settings.push_back({value.key, value.unit, std::vector<std::optional<std::string>>(lists.size())});
      settings[place->second].values[i] = value.value;
    }
  }
  std::erase_if(settings, [](const SettingDifference& setting) {
    return std::all_of(setting.values.begin(), setting.values.end(),
                       [&](const auto& value) { return value == setting.values.front(); });
  });
  return settings;
}

double delay_by_correlation(const Recording& one, const Recording& other) {
  const double period = 1e-9 * static_cast<double>(std::max(one.period, other.period).count());
  const double first_period = std::max(coarse, period);
  const double about = delay_at(one, other, first_period, std::nullopt);
  return first_period > period ? delay_at(one, other, period, about) : about;
}

}  // namespace flinch
