#include "systems/framework/duration_histogram.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace flinch {
namespace {

constexpr int bits_of_a_bin = 5;  // 2^5 bins an octave
constexpr std::int64_t bins_an_octave = 1 << bits_of_a_bin;

}  // namespace

// A number's leading six bits say where in its octave it is: below 64 each number has its own bin.
std::size_t DurationHistogram::bin(std::int64_t ns) {
  const auto number = static_cast<std::uint64_t>(ns);
  const int dropped_bits = std::max(0, static_cast<int>(std::bit_width(number)) - (bits_of_a_bin + 1));
  const auto leading = static_cast<std::int64_t>(number >> dropped_bits);
  return static_cast<std::size_t>(std::min<std::int64_t>(dropped_bits * bins_an_octave + leading, bins - 1));
}

std::int64_t DurationHistogram::largest_in(std::size_t bin) {
  if (bin + 1 == bins) return Time::max().count();
  const auto number = static_cast<std::int64_t>(bin);
  const std::int64_t dropped_bits = std::max<std::int64_t>(0, number / bins_an_octave - 1);
  const std::int64_t leading = number - dropped_bits * bins_an_octave;
  return ((leading + 1) << dropped_bits) - 1;
}

void DurationHistogram::add(Time duration) {
  const Time counted = std::max(duration, Time::zero());
  ++counts_[bin(counted.count())];
  ++count_;
  sum_ += counted;
  min_ = std::min(min_, counted);
  max_ = std::max(max_, counted);
}

Time DurationHistogram::quantile(double q) const {
  const auto wanted = static_cast<std::int64_t>(std::ceil(q * static_cast<double>(count_)));
  std::int64_t seen = 0;
  for (std::size_t i = 0; i < counts_.size(); ++i) {
    seen += counts_[i];
    if (seen >= wanted) return std::min(max_, Time(largest_in(i)));
  }
  return max_;
}

std::optional<DurationSummary> DurationHistogram::summary() const {
  if (count_ == 0) return std::nullopt;
  return DurationSummary{count_, min_, sum_ / count_, quantile(0.5), quantile(0.99), quantile(0.999), max_};
}

}  // namespace flinch
