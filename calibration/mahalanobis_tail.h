#pragma once

#include <vector>

namespace flinch {

/// How seldom large Mahalanobis distances chi are: P(chi > x) falls as exp(-(x / c)^q). Were all errors
/// normal, independent and as large as expected, chi^2 would be chi-square, and q = 2. Their true variance
/// varies about the expected one, which makes chi^2 scatter more and the tail longer: q falls from 2 to 1
/// while the relative variance of the variance rises from 0 to 0.2. Thresholds so extrapolated keep the rate
/// that is asked for 2 to 6 drives and up to a variation of 0.3, where the variance is distributed
/// log-normally. (Derived.)
class MahalanobisTail {
 public:
  /// The distance of a residual with an entry for each of so many drives; one that is not finite tells
  /// nothing.
  void add(double distance, int drives);
  /// What is added from now on is of another robot; without a call all is of the one that shall be judged.
  void begin_robot();

  /// Relative variance of the errors' variance, about what is expected; below zero where chi^2 scatters even
  /// less than chi-square. Zero without samples.
  double variation() const;
  /// The part of it by which robots differ: relative variance of the mean chi^2 of each. Zero of one robot.
  double between_robots() const;
  /// q, of robots that differ by no more than these tell with such a confidence; 1 where one of many robots
  /// was seen, which tells nothing of the others.
  double power(double confidence) const;

 private:
  static constexpr double least_power = 1.0;

  struct Robot {
    double count = 0.0;
    double squares = 0.0;  ///< sum of chi^2
  };

  std::vector<Robot> robots_{1};
  bool is_one_ = true;
  double fourth_ = 0.0;  ///< sum of chi^4
  int drives_ = 1;
};

}  // namespace flinch
