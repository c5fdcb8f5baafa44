#pragma once

namespace flinch {

/// How far an estimate can be trusted, as its estimator sees it.
struct EstimatorHealth {
  /// What it measures with fails, or contradicts the rest: the estimate is that of the momentum observer that
  /// runs beside it.
  bool fallen_back = false;
  /// Mean of late of e^T S^-1 e / n, for an innovation e of n entries that should have the covariance S:
  /// about 1 where model and noise are as assumed. 0: the estimator has no innovation.
  double innovation = 0.0;
  /// Reciprocal condition number of the observability matrix over three samples, its columns scaled to length
  /// one: 0 where a state cannot be seen. 1: the estimator has no states to be seen.
  double observability = 1.0;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("fallen_back", "", self.fallen_back);
    visit("innovation", "", self.innovation);
    visit("observability", "", self.observability);
  }
};

}  // namespace flinch
