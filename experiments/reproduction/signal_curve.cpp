#include "experiments/reproduction/signal_curve.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <utility>

#include "experiments/campaign/reaction_summary.h"

namespace flinch {
namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();

std::vector<double> column_of(const Recording& recording, const SignalNumber& number) {
  return recording.column(number.signal, number.field, number.element);
}

/// The recorded number, less another that was recorded `earlier` samples before.
std::vector<double> values_of(const SignalCurve::Term& term, const Recording& recording,
                              std::size_t earlier) {
  std::vector<double> values = column_of(recording, term.of);
  if (!term.less) return values;
  const std::vector<double> less = column_of(recording, *term.less);
  for (std::size_t k = 0; k < values.size(); ++k) values[k] -= k >= earlier ? less[k - earlier] : none;
  return values;
}

double sum_of_squares(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value * value;
  return sum;
}

double mean_of(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

double rms_of(const std::vector<double>& values) {
  return std::sqrt(sum_of_squares(values) / static_cast<double>(values.size()));
}

/// How long the curve stays at a stretch where `is_in` is true, from sample to sample.
template <class IsIn>
double longest_stretch(const CurveSamples& curve, IsIn is_in) {
  double longest = 0.0;
  std::optional<double> since;
  for (std::size_t k = 0; k < curve.value.size(); ++k) {
    if (!is_in(curve.value[k])) {
      since.reset();
    } else if (!since) {
      since = curve.time[k];
    }
    if (since) longest = std::max(longest, curve.time[k] - *since);
  }
  return longest;
}

/// Of a curve compared with another.
std::optional<double> compared(CurveStatistic::Kind kind, const CurveSamples& curve,
                               const CurveSamples& other) {
  const auto [values, others] = pairs_of(curve, other);
  if (values.empty()) return std::nullopt;
  if (kind == CurveStatistic::Kind::slope) {
    const std::optional<ForceFit> line = fit_line(others, values);
    return line ? std::optional(line->slope) : std::nullopt;
  }
  if (kind == CurveStatistic::Kind::signal_to_noise)
    return 10.0 * std::log10(sum_of_squares(others) / sum_of_squares(values));
  const auto [least, most] = std::minmax_element(others.begin(), others.end());
  return *most > *least ? std::optional(rms_of(values) / (*most - *least)) : std::nullopt;
}

}  // namespace

std::optional<SignalNumber> signal_number(const std::string& text) {
  const std::size_t point = text.find('.');
  if (point == 0 || point == std::string::npos || point + 1 == text.size()) return std::nullopt;
  SignalNumber number{text.substr(0, point), text.substr(point + 1)};
  const std::size_t bracket = number.field.find('[');
  if (bracket == std::string::npos) return number;
  const char* const end = number.field.data() + number.field.size() - 1;
  const auto [stopped, error] = std::from_chars(number.field.data() + bracket + 1, end, number.element);
  if (error != std::errc() || stopped != end || *end != ']' || number.element < 0) return std::nullopt;
  number.field.resize(bracket);
  return number;
}

std::vector<std::string> SignalCurve::signals() const {
  std::vector<std::string> names;
  for (const Term& term : terms) {
    names.push_back(term.of.signal);
    if (term.less) names.push_back(term.less->signal);
  }
  if (where) names.push_back(where->signal);
  return names;
}

std::optional<CurveSamples> sampled(const SignalCurve& curve, const Recording& recording,
                                    std::optional<double> contact) {
  if (curve.since_contact && !contact) return std::nullopt;
  const double start = curve.since_contact ? *contact : 0.0;
  const auto earlier = static_cast<std::size_t>(
      std::llround(1e9 * curve.less_earlier / static_cast<double>(recording.period.count())));
  std::vector<std::vector<double>> terms;
  for (const SignalCurve::Term& term : curve.terms) terms.push_back(values_of(term, recording, earlier));
  const std::vector<double> counts =
      curve.where ? column_of(recording, *curve.where) : std::vector<double>(recording.samples(), 1.0);
  CurveSamples samples;
  for (std::size_t k = 0; k < recording.samples(); ++k) {
    const double time = 1e-9 * static_cast<double>(recording.time_ns[k]) - start;
    if ((curve.from && time < *curve.from) || (curve.to && time > *curve.to) || counts[k] == 0.0) continue;
    double value = terms.front()[k];
    if (curve.is_length) {
      value = 0.0;
      for (const std::vector<double>& term : terms) value += term[k] * term[k];
      value = std::sqrt(value);
    }
    if (!std::isfinite(value)) continue;
    samples.time.push_back(time);
    samples.value.push_back(curve.times * value);
  }
  return samples;
}

std::pair<std::vector<double>, std::vector<double>> pairs_of(const CurveSamples& one,
                                                             const CurveSamples& two) {
  std::pair<std::vector<double>, std::vector<double>> pairs;
  std::size_t j = 0;
  for (std::size_t i = 0; i < one.time.size(); ++i) {
    while (j < two.time.size() && two.time[j] < one.time[i]) ++j;
    if (j == two.time.size() || two.time[j] != one.time[i]) continue;
    pairs.first.push_back(one.value[i]);
    pairs.second.push_back(two.value[j]);
  }
  return pairs;
}

const char* word(CurveStatistic::Kind kind) {
  constexpr std::array words = {
      "largest",       "least",         "last",  "mean",           "rms",
      "longest_below", "longest_above", "slope", "share_of_range", "signal_to_noise"};
  return words.at(static_cast<std::size_t>(kind));
}

bool needs_other(CurveStatistic::Kind kind) {
  return kind == CurveStatistic::Kind::slope || kind == CurveStatistic::Kind::share_of_range ||
         kind == CurveStatistic::Kind::signal_to_noise;
}

bool needs_level(CurveStatistic::Kind kind) {
  return kind == CurveStatistic::Kind::longest_below || kind == CurveStatistic::Kind::longest_above;
}

std::optional<double> taken(const CurveStatistic& statistic, const CurveSamples& curve,
                            const CurveSamples& other) {
  if (curve.value.empty()) return std::nullopt;
  const double level = statistic.level;
  switch (statistic.kind) {
    case CurveStatistic::Kind::largest:
      return *std::max_element(curve.value.begin(), curve.value.end());
    case CurveStatistic::Kind::least:
      return *std::min_element(curve.value.begin(), curve.value.end());
    case CurveStatistic::Kind::last:
      return curve.value.back();
    case CurveStatistic::Kind::mean:
      return mean_of(curve.value);
    case CurveStatistic::Kind::rms:
      return rms_of(curve.value);
    case CurveStatistic::Kind::longest_below:
      return longest_stretch(curve, [level](double value) { return value < level; });
    case CurveStatistic::Kind::longest_above:
      return longest_stretch(curve, [level](double value) { return value > level; });
    case CurveStatistic::Kind::slope:
    case CurveStatistic::Kind::share_of_range:
    case CurveStatistic::Kind::signal_to_noise:
      break;
  }
  return compared(statistic.kind, curve, other);
}

}  // namespace flinch
