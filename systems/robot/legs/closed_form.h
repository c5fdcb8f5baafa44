#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <vector>

#include "systems/robot/legs/leg_closure.h"

namespace flinch {

/// Which of the ways in which a leg reaches a point is meant: each 1 or -1.
struct Assembly {
  double bend = 1.0;  ///< beta: to which side an arm bends, or which way a telescope points.
  double turn = 1.0;  ///< gamma: of the two axes of a universal joint.
};

/// A leg whose joint coordinates follow from where its tip is held, without iteration.
///
/// | form      | joints from the base to the tip                                                    |
/// | arm       | one that turns or slides, then two that turn about axes which cross at right angles |
/// | telescope | two such, then one that slides along the line to the tip                            |
///
/// The last axis that turns is across the line to the tip. In the plane one turning joint takes the place of
/// the two. Joints that follow others may hang on all of them.
class ClosedForm {
 public:
  /// The form of `chain` with these closures; nothing where it has none.
  static std::optional<ClosedForm> of(const LegChain& chain, const std::vector<ChainClosure>& closures);

  /// Coordinates that bring the tip to `target` in the base frame; false where it does not reach.
  bool solve(const LegChain& chain, const Eigen::Vector3d& target, const Assembly& assembly,
             LegCoordinates& s) const noexcept;

  bool is_arm() const noexcept { return is_arm_; }
  bool has_two_axes() const noexcept { return turns_.size() == 2; }

 private:
  struct Frame {
    Eigen::Vector3d origin;
    Eigen::Matrix3d axes;
  };

  std::optional<Frame> reach(const LegChain& chain, const Eigen::Vector3d& target, double bend,
                             LegCoordinates& s) const noexcept;
  bool point_at(const LegChain& chain, const Frame& from, const Eigen::Vector3d& way, double turn,
                LegCoordinates& s) const noexcept;
  static void set(const ChainJoint& joint, double q, LegCoordinates& s) noexcept {
    s[joint.coordinate] = (q - joint.offset) / joint.ratio;
  }

  bool is_arm_ = false;
  std::size_t first_ = 0;           ///< The joint of an arm that bends or carries it, or that slides last.
  std::vector<std::size_t> turns_;  ///< One or two joints that turn at one point.
  Eigen::Vector3d rod_{0.0, 0.0,
                       0.0};  ///< From that point towards the tip, in the last of their frames at zero.
  double length_ = 0.0;       ///< Of that rod, of a telescope at zero.
};

}  // namespace flinch
