#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "systems/framework/recording.h"

namespace flinch {

/// A number of a recording by its signal and its field, such as "wrench.wrench_in_base[0]" or
/// "measures.sigma_sc".
struct SignalNumber {
  std::string signal;
  std::string field;
  int element = 0;  ///< of a vector

  bool operator==(const SignalNumber&) const = default;
};

/// The reverse of how it is written; none where the text is no such number.
std::optional<SignalNumber> signal_number(const std::string& text);

/// A number over the time of a run.
struct SignalCurve {
  /// One recorded number, or what is left of it when another is taken off.
  struct Term {
    SignalNumber of;
    std::optional<SignalNumber> less;
  };
  std::vector<Term> terms;            ///< one, or those of a vector
  bool is_length = false;             ///< root of the sum of the squares of the terms; else there is one term
  double times = 1.0;                 ///< factor
  double less_earlier = 0.0;          ///< by which what is taken off was recorded before [s]
  bool since_contact = false;         ///< times are counted from the first contact, else from the start
  std::optional<double> from, to;     ///< first and last time [s]
  std::optional<SignalNumber> where;  ///< a flag: other samples do not count

  /// Names of the signals that it is made of.
  std::vector<std::string> signals() const;
};

/// Samples of a curve, those that are numbers.
struct CurveSamples {
  std::vector<double> time;  ///< [s]
  std::vector<double> value;
};

/// The curve of a recording; `contact`: when the first began [s]. None where times are counted from a
/// contact and there is none. Throws SetupError with the nearest name for a signal that is not recorded.
std::optional<CurveSamples> sampled(const SignalCurve& curve, const Recording& recording,
                                    std::optional<double> contact);

/// The values of both where they have samples of the same time.
std::pair<std::vector<double>, std::vector<double>> pairs_of(const CurveSamples& one,
                                                             const CurveSamples& other);

/// What is taken of a curve.
struct CurveStatistic {
  enum class Kind {
    largest,
    least,
    last,
    mean,
    rms,             ///< root of the mean square
    longest_below,   ///< stretch below the level [s]
    longest_above,   ///< stretch above the level [s]
    slope,           ///< of the straight line over another curve, by least squares
    share_of_range,  ///< rms in shares of the range of another curve: the NRMSE of an error
    signal_to_noise  ///< squares of another curve over those of this one [dB]
  };
  Kind kind = Kind::largest;
  double level = 0.0;                ///< for the longest stretches
  std::optional<SignalCurve> other;  ///< for slope, share_of_range and signal_to_noise
};

/// "largest", ..., as enumerators are called.
const char* word(CurveStatistic::Kind kind);

/// Whether a statistic asks for another curve, or for a level.
bool needs_other(CurveStatistic::Kind kind);
bool needs_level(CurveStatistic::Kind kind);

/// None where the curve has no samples, or too few for a line. `other`: samples of the statistic's other
/// curve, paired with those of `curve` by their times.
std::optional<double> taken(const CurveStatistic& statistic, const CurveSamples& curve,
                            const CurveSamples& other = {});

}  // namespace flinch
