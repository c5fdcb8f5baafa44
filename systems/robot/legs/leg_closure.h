#pragma once

#include <Eigen/Core>

#include "systems/robot/legs/leg_chain.h"
#include "systems/robot/legs/platform_twist.h"

namespace flinch {

/// Largest number of rows that the closures of a leg have together.
inline constexpr int max_closure_rows = 18;

using ClosureVector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, max_closure_rows, 1>;
/// One column a coordinate of the leg.
using ClosureMatrix =
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, max_closure_rows, max_leg_coordinates>;
/// One column a platform coordinate, or a chart number.
using ClosureMap = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, max_closure_rows, max_dof>;

/// A point or frame A of a leg's link that coincides with B, one of the platform, the base or another link of
/// the leg. Its rows are e = [x_B - x_A; Log(R_B R_A^T)], without those that vanish in the plane.
struct ChainClosure {
  enum class On { platform, base, joint };

  std::size_t joint = 0;
  Eigen::Vector3d at{0.0, 0.0, 0.0};                   ///< A in the frame of its link [m].
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();  ///< Axes of A in it.
  On on = On::platform;
  std::size_t on_joint = 0;
  Eigen::Vector3d on_at{0.0, 0.0, 0.0};  ///< B in its body [m].
  Eigen::Matrix3d on_turn = Eigen::Matrix3d::Identity();
  bool holds_frame = false;
  bool planar = false;

  /// Rows of a position: 2 or 3.
  int directions() const noexcept { return planar ? 2 : 3; }
  /// Rows of a frame's orientation.
  int rotations() const noexcept { return !holds_frame ? 0 : planar ? 1 : 3; }
  int rows() const noexcept { return directions() + rotations(); }

  /// A's position in the base frame.
  Eigen::Vector3d point(const ChainPlace& place) const noexcept {
    return place.origin[joint] + place.axes[joint] * at;
  }
  /// The rows of e from `first` on.
  void residual(const ChainPlace& place, const PlatformTwist& platform, int first,
                ClosureVector& e) const noexcept;
  /// The rows of J: columns of A, less those of B where that is a link.
  void rows_of_leg(const LegChain& chain, const ChainPlace& place, int first,
                   ClosureMatrix& J) const noexcept;
  /// The same with the time derivative.
  void rows_of_leg(const LegChain& chain, const ChainPlace& place, const ChainRates& rates, int first,
                   ClosureMatrix& J, ClosureMatrix& dJ) const noexcept;
  /// The rows of P: how B moves with columns of twists of the platform.
  template <class Twists>
  void rows_of_platform(const PlatformTwist& platform, const Twists& T, int first,
                        ClosureMap& P) const noexcept;
  /// The rows of dP from T and its derivative.
  template <class Twists>
  void rate_rows_of_platform(const PlatformTwist& platform, const Twists& T, const Twists& dT, int first,
                             ClosureMap& dP) const noexcept;

 private:
  template <class Vector, class Matrix>
  void write(const Vector& velocity, const Vector& turning, int first, int column,
             Matrix& out) const noexcept {
    for (int i = 0; i < directions(); ++i) out(first + i, column) = velocity[i];
    const int rotation = rotations();
    for (int i = 0; i < rotation; ++i) out(first + directions() + i, column) = turning[3 - rotation + i];
  }
};

// P = [t_t + t_w x r; t_w] for each column t of T, r = R b.
template <class Twists>
void ChainClosure::rows_of_platform(const PlatformTwist& platform, const Twists& T, int first,
                                    ClosureMap& P) const noexcept {
  if (on != On::platform) return P.middleRows(first, rows()).setZero(), void();
  const Eigen::Vector3d r = platform.axes * on_at;
  for (int i = 0; i < T.cols(); ++i) {
    const Eigen::Vector3d t = T.col(i).template head<3>();
    const Eigen::Vector3d w = T.col(i).template tail<3>();
    const Eigen::Vector3d moved = t + w.cross(r);
    write(moved, w, first, i, P);
  }
}

// dP = [dt_t + dt_w x r + t_w x (omega x r); dt_w].
template <class Twists>
void ChainClosure::rate_rows_of_platform(const PlatformTwist& platform, const Twists& T, const Twists& dT,
                                         int first, ClosureMap& dP) const noexcept {
  if (on != On::platform) return dP.middleRows(first, rows()).setZero(), void();
  const Eigen::Vector3d r = platform.axes * on_at;
  const Eigen::Vector3d r_rate = platform.omega().cross(r);
  for (int i = 0; i < T.cols(); ++i) {
    const Eigen::Vector3d w = T.col(i).template tail<3>();
    const Eigen::Vector3d dt = dT.col(i).template head<3>();
    const Eigen::Vector3d dw = dT.col(i).template tail<3>();
    const Eigen::Vector3d moved = dt + dw.cross(r) + w.cross(r_rate);
    write(moved, dw, first, i, dP);
  }
}

}  // namespace flinch
