#pragma once

#include <Eigen/Core>
#include <optional>
#include <random>
#include <vector>

#include "convert/closed_chains.h"

namespace flinch {

/// Where all parts of closed chains stand.
struct ChainState {
  std::vector<Eigen::VectorXd> s;                              ///< Coordinates of each leg [rad or m].
  Eigen::Isometry3d platform = Eigen::Isometry3d::Identity();  ///< E in the base frame.
};

/// Where nothing has moved.
ChainState resting_state(const ClosedChains& chains);

/// Placement of the frame of each link of a leg: base frame.
std::vector<Eigen::Isometry3d> link_places(const ChainLeg& leg, const Eigen::VectorXd& s);

/// Rows e = [x_B - x_A; Log(R_B R_A^T)] of the joins of all legs, without those that vanish in the plane, and
/// their derivative by the coordinates of all legs and by the twist of the platform.
struct ClosureRows {
  Eigen::VectorXd e;
  Eigen::MatrixXd J;           ///< One column a coordinate, then six for the platform, or in the plane three.
  std::vector<int> first_row;  ///< Of each leg, and the count of all.
  std::vector<int> first_column;  ///< Of each leg, and that of the platform.
};
ClosureRows closure_rows(const ClosedChains& chains, const ChainState& state);

/// Moves `state` by a step in coordinates and twist.
void move(const ClosedChains& chains, const Eigen::VectorXd& step, ChainState& state);

/// The state nearest to `state` with closed loops, by steps of least change; nothing where none is found.
std::optional<ChainState> closed(const ClosedChains& chains, ChainState state, double tolerance);

/// Motions that closed loops leave, as orthonormal columns: rates of the coordinates and the twist, angles of
/// the platform times `length`.
Eigen::MatrixXd free_motions(const ClosedChains& chains, const ChainState& state, double length);

}  // namespace flinch
