#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "systems/robot/legs/closed_form.h"
#include "systems/robot/legs/leg_closure.h"
#include "systems/robot/legs/legs_parameters.h"
#include "systems/robot/legs/platform_twist.h"
#include "systems/robot/mechanism.h"

namespace flinch {

/// A leg as its equations need it.
struct ModelLeg {
  LegChain chain;
  std::vector<ChainClosure> closures;
  int rows = 0;                    ///< c: of all closures.
  std::optional<ClosedForm> form;  ///< How it is solved; otherwise by following a path from home.
  Assembly assembly;               ///< Of that form, at home.
  LegCoordinates home;             ///< s at home.
  double home_determinant = 1.0;   ///< Of the closures, as ClosureFactor tells it.
  /// Of a leg with more rows than coordinates: as many of them, independent at home, which tell on which side
  /// of singularities it is; empty otherwise.
  std::vector<int> side_rows;
  double home_side = 1.0;  ///< Their determinant at home.

  bool is_square() const noexcept { return rows == chain.coordinates; }
  /// Of J, whose ClosureFactor tells `determinant`: positive on the side of singularities on which the robot
  /// is at home.
  double side(const ClosureMatrix& J, double determinant) const noexcept;
  void residual(const ChainPlace& place, const PlatformTwist& platform, ClosureVector& e) const noexcept;
  void matrix(const ChainPlace& place, ClosureMatrix& J) const noexcept;
  void matrix(const ChainPlace& place, const ChainRates& rates, ClosureMatrix& J,
              ClosureMatrix& dJ) const noexcept;
  template <class Twists>
  void platform_map(const PlatformTwist& platform, const Twists& T, ClosureMap& P) const noexcept {
    P.resize(rows, T.cols());
    int first = 0;
    for (const ChainClosure& closure : closures) {
      closure.rows_of_platform(platform, T, first, P);
      first += closure.rows();
    }
  }
  template <class Twists>
  void platform_map_rate(const PlatformTwist& platform, const Twists& T, const Twists& dT,
                         ClosureMap& dP) const noexcept {
    dP.resize(rows, T.cols());
    int first = 0;
    for (const ChainClosure& closure : closures) {
      closure.rate_rows_of_platform(platform, T, dT, first, dP);
      first += closure.rows();
    }
  }
};

/// A joint of a leg.
struct JointOfLeg {
  std::size_t leg = 0;
  std::size_t joint = 0;
};

/// A drive: its position is zero + sum of weight times joint position.
struct ModelDrive {
  struct Term : JointOfLeg {
    double weight = 1.0;
  };
  std::vector<Term> terms;
  double zero = 0.0;
  DriveKind kind = DriveKind::revolute;
};

/// Coordinates of all legs, and the chart numbers that follow.
struct LegsState {
  std::array<LegCoordinates, max_dof> s;
  FollowingVector z;
};

/// A robot of legs as its equations need it, assembled at home.
struct LegsModel {
  PlatformMoves moves;
  Eigen::Vector3d home_position{0.0, 0.0, 0.0};
  Eigen::Matrix3d home_axes = Eigen::Matrix3d::Identity();
  double home_angle = 0.0;  ///< Of a planar pose [rad].
  double characteristic_length = 1.0;
  Eigen::Vector3d gravity{0.0, 0.0, 0.0};
  RigidBodyInertia platform;  ///< With payload.
  RigidBodyInertia payload;   ///< No mass: none.
  std::vector<ModelLeg> legs;
  std::vector<ModelDrive> drives;
  std::vector<JointOfLeg> measured;  ///< Passive joints with encoders.
  /// The link of each body but the platform, two a leg; a body without a link moves with the leg's last.
  std::vector<JointOfLeg> bodies;
  FollowingVector home_following;       ///< z at home.
  double home_rest_determinant = 1.0;   ///< Of what determines z, as RestFactor tells it.
  double home_drive_determinant = 1.0;  ///< det A, or the root of det A^T A, at home.

  int following() const noexcept { return static_cast<int>(home_following.size()); }
  ChartNumbers home_chart() const noexcept;
  /// The chart numbers of a usable `pose`, with z where they follow.
  ChartNumbers chart(const Configuration& pose, const FollowingVector& z) const noexcept;
  /// Places `out`, origin and axes.
  void place(const Configuration& pose, const FollowingVector& z, PlatformTwist& out) const noexcept;
  void place(const ChartNumbers& chart, PlatformTwist& out) const noexcept;
};

/// The model of `parameters`, and what is wrong with it or with them, each as one sentence that begins with
/// the field; the model serves where there is nothing.
struct AssembledLegs {
  LegsModel model;
  std::vector<std::string> problems;
};
AssembledLegs legs_model(const LegsParameters& parameters);

}  // namespace flinch
