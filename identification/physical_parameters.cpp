#include "identification/physical_parameters.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "systems/foundation/setup_error.h"
#include "systems/robot/decompositions.h"

namespace flinch {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double unbounded = -1e8;      // a least value below it bounds nothing
constexpr double first_barrier = 1e-2;  // of the distance to be minimised
constexpr double last_barrier = 1e-10;  // likewise
constexpr double least_room = 1e-9;     // of a least value, on which what is believed may lie

bool is_bounded(const DynamicParameter& parameter) { return parameter.least > unbounded; }

/// S(x) = S_0 + sum x_j S_j must be positive definite; x in deviations of what is believed.
struct Condition {
  MatrixXd constant;
  std::vector<MatrixXd> slopes;

  MatrixXd at(const VectorXd& x) const {
    MatrixXd S = constant;
    for (Eigen::Index j = 0; j < x.size(); ++j) S += x[j] * slopes[static_cast<std::size_t>(j)];
    return S;
  }
};

VectorXd deviations(const DynamicParameters& parameters) {
  VectorXd deviation(static_cast<Eigen::Index>(parameters.list().size()));
  for (Eigen::Index j = 0; j < deviation.size(); ++j)
    deviation[j] = parameters.list()[static_cast<std::size_t>(j)].deviation;
  return deviation;
}

/// The matrices are linear in the values, so that differences are their slopes exactly. A least value is a
/// matrix of one row.
std::vector<Condition> conditions_of(const DynamicParameters& parameters) {
  const VectorXd believed = parameters.believed(), deviation = deviations(parameters);
  const std::vector<MatrixXd> base = parameters.must_be_definite(believed);
  std::vector<Condition> conditions(base.size());
  for (std::size_t k = 0; k < base.size(); ++k) {
    conditions[k].constant = base[k];
  }
  for (Eigen::Index j = 0; j < believed.size(); ++j) {
    VectorXd moved = believed;
    moved[j] += deviation[j];
    const std::vector<MatrixXd> there = parameters.must_be_definite(moved);
    for (std::size_t k = 0; k < base.size(); ++k) conditions[k].slopes.push_back(there[k] - base[k]);
  }
  for (Eigen::Index j = 0; j < believed.size(); ++j) {
    const DynamicParameter& parameter = parameters.list()[static_cast<std::size_t>(j)];
    if (!is_bounded(parameter)) continue;
    Condition bound;
    const double room = (parameter.believed - parameter.least) / deviation[j] + least_room;
    bound.constant = MatrixXd::Constant(1, 1, room);
    bound.slopes.assign(static_cast<std::size_t>(believed.size()), MatrixXd::Zero(1, 1));
    bound.slopes[static_cast<std::size_t>(j)](0, 0) = 1.0;
    conditions.push_back(std::move(bound));
  }
  return conditions;
}

/// The distance with its barrier; infinite outside.
class Barrier {
 public:
  Barrier(const std::vector<Condition>& conditions, MatrixXd H, VectorXd target, double weight)
      : conditions_(conditions), H_(std::move(H)), target_(std::move(target)), weight_(weight) {}

  double value(const VectorXd& x) const {
    double sum = 0.5 * (x - target_).dot(H_ * (x - target_));
    for (const Condition& condition : conditions_) {
      const Eigen::LLT<MatrixXd> root(condition.at(x));
      if (root.info() != Eigen::Success) return std::numeric_limits<double>::infinity();
      sum -= 2.0 * weight_ * root.matrixLLT().diagonal().array().log().sum();
    }
    return sum;
  }

  /// The step of Newton's method, and by how much it lowers the value to first order.
  VectorXd step(const VectorXd& x, double& decrement) const {
    VectorXd gradient = H_ * (x - target_);
    MatrixXd curvature = H_;
    for (const Condition& condition : conditions_) {
      const Eigen::LLT<MatrixXd> root(condition.at(x));
      std::vector<MatrixXd> relative;  // S^-1 S_j
      for (const MatrixXd& slope : condition.slopes) relative.push_back(root.solve(slope));
      for (Eigen::Index i = 0; i < x.size(); ++i) {
        const MatrixXd& of_i = relative[static_cast<std::size_t>(i)];
        gradient[i] -= weight_ * of_i.trace();
        for (Eigen::Index j = 0; j <= i; ++j) {
          const double change = weight_ * (of_i * relative[static_cast<std::size_t>(j)]).trace();
          curvature(i, j) += change;
          if (j < i) curvature(j, i) += change;
        }
      }
    }
    const VectorXd step = -curvature.ldlt().solve(gradient);
    decrement = -gradient.dot(step);
    return step;
  }

 private:
  const std::vector<Condition>& conditions_;
  MatrixXd H_;
  VectorXd target_;
  double weight_;
};

void minimise(const Barrier& barrier, VectorXd& x) {
  for (int iteration = 0; iteration < 100; ++iteration) {
    double decrement = 0.0;
    const VectorXd step = barrier.step(x, decrement);
    const double value = barrier.value(x);
    if (!(decrement > 1e-12 * std::abs(value))) return;
    double share = 1.0;
    while (share > 1e-12 && !(barrier.value(x + share * step) < value - 0.1 * share * decrement))
      share *= 0.5;
    if (share <= 1e-12) return;
    x += share * step;
  }
}

}  // namespace

bool is_physical(const DynamicParameters& parameters, const VectorXd& values) {
  for (Eigen::Index j = 0; j < values.size(); ++j) {
    if (values[j] < parameters.list()[static_cast<std::size_t>(j)].least) return false;
  }
  for (const MatrixXd& S : parameters.must_be_definite(values)) {
    if (Eigen::SelfAdjointEigenSolver<MatrixXd>(S, Eigen::EigenvaluesOnly).eigenvalues()[0] <= 0.0)
      return false;
  }
  return true;
}

VectorXd nearest_physical(const DynamicParameters& parameters, const VectorXd& values,
                          const MatrixXd& information) {
  const VectorXd believed = parameters.believed(), deviation = deviations(parameters);
  const std::vector<Condition> conditions = conditions_of(parameters);
  const MatrixXd H = deviation.asDiagonal() * information * deviation.asDiagonal();
  const VectorXd target = (values - believed).cwiseQuotient(deviation);
  VectorXd x = VectorXd::Zero(values.size());
  const double distance = 0.5 * target.dot(H * target);
  if (!std::isfinite(Barrier(conditions, H, target, 0.0).value(x))) {
    throw SetupError(
        "no robot can have the masses and moments of inertia of the robot file, which the calibration begins "
        "with: each moment of inertia must be less than the sum of the other two, and of a leg p3^2 less "
        "than p2 (p1 - p2); correct the robot file");
  }
  for (double share = first_barrier; share >= last_barrier; share *= 0.1)
    minimise(Barrier(conditions, H, target, share * std::max(distance, 1.0)), x);
  VectorXd nearest = believed + deviation.cwiseProduct(x);
  for (Eigen::Index j = 0; j < x.size(); ++j)
    nearest[j] = std::max(nearest[j], parameters.list()[static_cast<std::size_t>(j)].least);
  return nearest;
}

}  // namespace flinch
