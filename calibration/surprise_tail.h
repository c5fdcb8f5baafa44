#pragma once

namespace flinch {

/// How seldom large surprises are: P(chi > x) falls as exp(-(x / c)^q). Were all errors normal, independent
/// and as large as expected, chi^2 would be chi-square, and q = 2. Their true variance varies about the
/// expected one, which makes chi^2 scatter more and the tail longer: q falls from 2 to 1 while the relative
/// variance of the variance rises from 0 to 0.2. Thresholds so extrapolated keep the rate that is asked for 2
/// to 6 drives and up to a variation of 0.3, where the variance is distributed log-normally. (Derived.)
class SurpriseTail {
 public:
  /// A surprise chi of a residual with an entry for each of so many drives; one that is not finite tells
  /// nothing.
  void add(double surprise, int drives);

  /// Relative variance of the errors' variance, about what is expected; below zero where chi^2 scatters even
  /// less than chi-square. Zero without samples.
  double variation() const;
  /// q.
  double power() const;

 private:
  double count_ = 0.0;
  double squares_ = 0.0;  ///< sum of chi^2
  double fourth_ = 0.0;   ///< and of chi^4
  int drives_ = 1;
};

}  // namespace flinch
