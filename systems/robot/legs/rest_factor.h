#pragma once

#include "systems/robot/decompositions.h"
#include "systems/robot/legs/closure_factor.h"

namespace flinch {

/// Largest number of rows of all legs together that determine the chart numbers that follow.
inline constexpr int max_rest_rows = 48;

/// The rows that no motion of the legs can bring about, Z = stack N_i P_i of all legs, which determine the
/// chart numbers that follow: Z z = -b, least squares where there are more rows.
class RestFactor {
 public:
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, max_rest_rows, max_dof>;

  /// Begins with no rows for `following` numbers.
  void start(int following) noexcept;
  /// Appends the rest rows of a leg whose closures move with these numbers by P_z.
  void add(const ClosureFactor& leg, const ClosureMap& P_z) noexcept;
  /// To be called after the last.
  void factor() noexcept;

  /// -Z^+ B
  Rows solve(const Rows& B) const noexcept;

  int rows() const noexcept { return static_cast<int>(Z_.rows()); }
  const Rows& matrix() const noexcept { return Z_; }
  /// Of the whole system of legs and following numbers, where that is square.
  double determinant() const noexcept { return determinant_; }
  /// |det Z|, or the root of det Z^T Z.
  double size() const noexcept { return size_; }

 private:
  Rows Z_;
  Eigen::HouseholderQR<Rows> factor_;
  double legs_ = 1.0;
  double determinant_ = 1.0;
  double size_ = 1.0;
};

/// Appends `rows` below `stack`.
template <class Right>
void append_rows(RestFactor::Rows& stack, const Right& rows) noexcept {
  const Eigen::Index before = stack.rows();
  stack.conservativeResize(before + rows.rows(), Eigen::NoChange);
  stack.bottomRows(rows.rows()) = rows;
}

}  // namespace flinch
