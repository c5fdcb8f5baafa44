#include "systems/robot/quadratic_programme.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include "systems/robot/decompositions.h"

namespace flinch {
namespace {

using Vector = ProgrammeVector;
using Matrix = ProgrammeMatrix;

constexpr double infinity = std::numeric_limits<double>::infinity();

/// The constraints that hold with equality, and the factors that follow them: with L L^T = H and N the
/// normals of the active constraints as columns, L^-1 N = Q [R; 0] and J = L^-T Q.
class ActiveSet {
 public:
  explicit ActiveSet(const Eigen::LLT<Matrix>& cholesky) : n_(static_cast<int>(cholesky.cols())) {
    J_ = cholesky.matrixU().solve(Matrix::Identity(n_, n_));
    R_.setZero(n_, n_);
  }

  int size() const { return size_; }
  int constraint(int place) const { return constraints_[static_cast<std::size_t>(place)]; }
  bool holds(int row) const {
    return std::find(constraints_.begin(), constraints_.begin() + size_, row) != constraints_.begin() + size_;
  }

  /// J^T of a normal: of its head follow the changes of the multipliers, of its tail the step.
  Vector turned(const Vector& normal) const { return J_.transpose() * normal; }
  Vector step_in_primal(const Vector& turned) const {
    return J_.rightCols(n_ - size_) * turned.tail(n_ - size_);
  }
  Vector change_of_multipliers(const Vector& turned) const {
    return R_.topLeftCorner(size_, size_).triangularView<Eigen::Upper>().solve(turned.head(size_));
  }

  /// Takes up constraint `row` whose normal, turned, is `turned`: rotates its tail onto its first entry.
  void add(int row, Vector turned) {
    for (int k = n_ - 1; k > size_; --k) rotate(turned, k);
    R_.col(size_).head(size_ + 1) = turned.head(size_ + 1);
    constraints_[static_cast<std::size_t>(size_++)] = row;
  }

  /// Drops the constraint at `place`, and rotates R back to a triangle.
  void drop(int place) {
    for (int k = place; k + 1 < size_; ++k) {
      R_.col(k) = R_.col(k + 1);
      constraints_[static_cast<std::size_t>(k)] = constraints_[static_cast<std::size_t>(k) + 1];
    }
    --size_;
    for (int k = place; k < size_; ++k) {
      Eigen::JacobiRotation<double> rotation;
      rotation.makeGivens(R_(k, k), R_(k + 1, k));
      R_.applyOnTheLeft(k, k + 1, rotation.adjoint());
      J_.applyOnTheRight(k, k + 1, rotation);
    }
  }

 private:
  /// Makes entry k of `turned` zero by turning it into entry k - 1, and J with it.
  void rotate(Vector& turned, int k) {
    Eigen::JacobiRotation<double> rotation;
    rotation.makeGivens(turned[k - 1], turned[k], &turned[k - 1]);
    turned[k] = 0.0;
    J_.applyOnTheRight(k - 1, k, rotation);
  }

  int n_;
  int size_ = 0;
  std::array<int, max_variables> constraints_{};
  Matrix J_;
  Matrix R_;
};

/// How far z may move towards a violated constraint.
struct Step {
  double length = infinity;
  int blocking = -1;  ///< place of the active constraint whose multiplier gets zero first; -1: none
};

Step longest_dual_step(const ActiveSet& active, const Vector& change, const Vector& multipliers) {
  Step step;
  for (int i = 0; i < active.size(); ++i) {
    if (change[i] <= 0.0) continue;
    const double length = multipliers[i] / change[i];
    if (length < step.length) step = {length, i};
  }
  return step;
}

bool is_well_posed(const QuadraticProgramme& p) {
  const auto n = p.f.size();
  const bool fits =
      n > 0 && p.H.rows() == n && p.H.cols() == n && p.C.cols() == n && p.C.rows() == p.d.size();
  return fits && p.H.allFinite() && p.f.allFinite() && p.C.allFinite() && p.d.allFinite();
}

/// The programme while it is being solved.
struct Search {
  const QuadraticProgramme& programme;
  ActiveSet active;
  Vector z;
  Vector multipliers;  ///< of the active constraints, by their places

  /// The row that is violated most, by its own scale; -1: none.
  int most_violated() const {
    int worst = -1;
    double most = 1e-10;
    for (int row = 0; row < programme.d.size(); ++row) {
      const double norm = programme.C.row(row).norm();
      const double scale = std::max({norm, norm * z.norm(), std::abs(programme.d[row])});
      const double violation = (programme.d[row] - programme.C.row(row).dot(z)) / scale;
      if (violation > most && !active.holds(row)) worst = row, most = violation;
    }
    return worst;
  }

  void drop(int place) {
    active.drop(place);
    for (int k = place; k < active.size(); ++k) multipliers[k] = multipliers[k + 1];
  }

  /// Moves until `row` holds, dropping what is in the way. Returns whether it can be made to hold.
  bool take_up(int row, int most_steps, int& steps) {
    const Vector normal = programme.C.row(row);
    double multiplier = 0.0;
    while (steps < most_steps) {
      ++steps;
      const Vector turned = active.turned(normal);
      const Vector direction = active.step_in_primal(turned);
      const Vector change = active.change_of_multipliers(turned);
      const double slope = direction.dot(normal);
      const bool is_free = slope > 1e-14 * turned.squaredNorm();
      const double gap = programme.d[row] - normal.dot(z);
      const double whole = is_free ? gap / slope : infinity;
      const Step dual = longest_dual_step(active, change, multipliers);
      const double length = std::min(whole, dual.length);
      if (length == infinity) return false;
      if (is_free) z += length * direction;
      multipliers.head(active.size()) -= length * change;
      multiplier += length;
      if (whole <= dual.length) {
        multipliers[active.size()] = multiplier;
        active.add(row, turned);
        return true;
      }
      drop(dual.blocking);
    }
    return true;
  }
};

}  // namespace

ProgrammeSolution solve(const QuadraticProgramme& programme, int most_steps) noexcept {
  using Status = ProgrammeSolution::Status;
  ProgrammeSolution solution;
  const auto n = programme.f.size();
  solution.z.setZero(n);
  solution.multipliers.setZero(programme.d.size());
  if (!is_well_posed(programme)) return solution;
  const Eigen::LLT<Matrix> cholesky(programme.H);
  if (cholesky.info() != Eigen::Success) return solution;

  Search search{programme, ActiveSet(cholesky), cholesky.solve(-programme.f), Vector::Zero(n)};
  solution.status = Status::too_many_steps;
  while (solution.steps < most_steps && solution.status == Status::too_many_steps) {
    const int row = search.most_violated();
    if (row < 0) {
      solution.status = Status::solved;
    } else if (!search.take_up(row, most_steps, solution.steps)) {
      solution.status = Status::infeasible;
    }
  }
  if (search.most_violated() < 0) solution.status = Status::solved;
  solution.z = search.z;
  for (int i = 0; i < search.active.size(); ++i)
    solution.multipliers[search.active.constraint(i)] = search.multipliers[i];
  return solution;
}

}  // namespace flinch
