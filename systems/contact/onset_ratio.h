#pragma once

#include <array>

#include "systems/contact/residual_errors.h"
#include "systems/contact/residual_sample.h"

namespace flinch {

/// How the error of a sample follows from those before it, each drive's divided by its deviation:
/// z_t = sum of a_j z_(t-j) + s e_t, where the e_t are independent and have deviation 1.
struct AutoregressiveError {
  static constexpr int order = 4;
  std::array<double, order> prediction{};  ///< a_1, a_2, ...
  double innovation = 1.0;                 ///< s
};

/// What is remembered of a residual's change.
struct OnsetMemory {
  static constexpr int longest = 16;                           ///< samples since an onset that is thought of
  int samples = 0;                                             ///< without a gap, as far as they are needed
  Time acquired{};                                             ///< the newest
  std::array<JointVector, AutoregressiveError::order> before;  ///< z, the newest first
  std::array<JointVector, longest> matched;  ///< sum of g e for an onset so many samples before the newest
};

/// The likelihood ratio of a force that began a few samples ago, against none: constant since, of any
/// direction and size, beside errors of a known course. Its signature g in the e_t is what the estimator
/// answers to a step of 1, seen as its change, without what the course predicts of it. The likeliest force of
/// an onset k leaves 2 ln L_k = |sum of g e|^2 / sum of g^2, which is chi-square without a contact; the
/// likeliest onset counts. (Derived; a generalised likelihood ratio, Willsky and Jones 1976.)
class OnsetRatio {
 public:
  /// `errors`: of the change of a residual that is followed as `tracking` says.
  OnsetRatio(const ResidualErrors& errors, const AutoregressiveError& course,
             const ResidualTracking& tracking);

  /// What is remembered after a residual was seen. Nothing, while its change means nothing; nothing of before
  /// a sample that is missing, for all that is known of errors is how they go from sample to sample.
  void follow(const ResidualSample& seen, const OnsetMemory& memory, OnsetMemory& next) const;
  /// Root of the largest 2 ln L_k: as long as a whitened residual. Zero while too little was seen, infinite
  /// where it is not finite.
  double mahalanobis_distance(const OnsetMemory& memory) const;

 private:
  ResidualErrors errors_;
  AutoregressiveError course_;
  Sampling sampling_;
  std::array<double, OnsetMemory::longest> signature_{};
  std::array<double, OnsetMemory::longest> energy_{};  ///< sum of its squares, up to each
};

}  // namespace flinch
