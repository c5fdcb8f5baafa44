#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>

#include "systems/contact/onset_ratio.h"
#include "systems/robot/vectors.h"

namespace flinch {

/// Finds the course of errors by which each is best told from those before it, in the mean square. However
/// many there are, they take no memory.
class AutoregressiveErrorFit {
 public:
  /// The errors of the drives at the next sample, divided by their deviations.
  void add(const JointVector& errors);
  /// What is added next does not follow what was: there is a gap.
  void interrupt() { samples_ = 0; }

  /// None where no sample had enough before it. The innovation is a thousandth of a deviation at least.
  std::optional<AutoregressiveError> course() const;

 private:
  static constexpr int order = AutoregressiveError::order;

  int samples_ = 0;                        ///< since the last gap, as far as they are needed
  std::array<JointVector, order> before_;  ///< the newest first
  // Over all samples of all drives: b are the errors before an error z.
  Eigen::Matrix<double, order, order> squares_ = Eigen::Matrix<double, order, order>::Zero();  ///< of b b^T
  Eigen::Matrix<double, order, 1> products_ = Eigen::Matrix<double, order, 1>::Zero();         ///< of b z
  double square_ = 0.0;                                                                        ///< of z^2
  double count_ = 0.0;
};

}  // namespace flinch
