#pragma once

#include <Eigen/Core>
#include <array>
#include <memory>
#include <vector>

#include "systems/contact/touch_pairs_settings.h"
#include "systems/contact/wrench_uncertainty.h"
#include "systems/robot/leg_bases.h"
#include "systems/robot/parallel_robot.h"
#include "systems/signals/base_force_estimate.h"
#include "systems/signals/located_contacts.h"

namespace flinch {

/// Which one or two contacts explain a wrench and the forces at the base joints together, in the plane. A
/// force f = (-n + mu t) a on the outline at a point with the normal n makes of both (J^T f, (I - Lambda)^T
/// f), see `LegBases`: with three legs nine numbers, where two contacts have six unknowns. a is half-normal
/// and mu normal with the settings' scales, so for given points the likelihood of all forces is in closed
/// form. It is climbed from the best of a coarse set of points on each side of each body, and of each two of
/// them; Laplace's approximation sums over the points about each summit. One and two contacts are weighed
/// with all bodies, and all pairs of them, as likely before. (Derived.)
class TouchPairs {
 public:
  /// Throws SetupError for a robot that does not move in the plane, or whose bodies have no simple outline.
  TouchPairs(std::shared_ptr<const ParallelRobot> robot, std::shared_ptr<const LegBases> bases,
             const TouchPairsSettings& settings);

  /// `wrench` and its `covariance`; not valid where something cannot be used. Never allocates.
  void find(const Kinematics& at, const PlatformVector& wrench, const PlatformMatrix& covariance,
            const BaseForceEstimate& bases, LocatedContacts& out) const noexcept;

 private:
  static constexpr int most_felt = max_dof + 3 * max_dof;
  static constexpr std::size_t most_sides = 32;
  using Felt = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, most_felt, 1>;
  using FeltMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, most_felt, most_felt>;

  /// One side of a link, or the platform all around.
  struct Side {
    int body = 0;
    double sign = 1.0;                           // of the normal across a link
    double length = 0.0;                         // [m]
    double radius = 0.0;                         // of platform or link [m]
    double axis_begin = 0.0, axis_length = 0.0;  // of a link, along x of its frame [m]
    int places = 0;                              // tried first

    bool is_round() const { return axis_length == 0.0; }
  };
  /// A point on a side, what it is and what a push and a drag there make of all that is felt, whitened.
  struct Touch {
    const Side* side = nullptr;
    double place = 0.0;  // 0 to 1 along the side
    Eigen::Vector2d point, normal;
    Felt push, drag;
  };
  struct Scene;
  struct Places;
  struct Summit;
  struct Explained;

  FeltMatrix covariance(const PlatformMatrix& of_wrench, const BaseForceEstimate& bases) const noexcept;
  Touch touch(const Scene& scene, const Side& side, double place) const noexcept;
  double step(const Side& side) const { return 1.0 / side.places; }
  void try_places(const Scene& scene, Places& places) const noexcept;
  Explained by_one(const Scene& scene, const Places& places) const noexcept;
  Explained by_two(const Scene& scene, const Places& places) const noexcept;
  template <std::size_t n>
  double climb(const Scene& scene, std::array<Touch, n>& touches) const noexcept;
  template <std::size_t n>
  double likelihood(const Scene& scene, const std::array<Touch, n>& touches,
                    Eigen::Matrix<double, 2 * static_cast<int>(n), 1>& forces) const noexcept;
  template <std::size_t n>
  Summit summit(const Scene& scene, std::array<Touch, n> from) const noexcept;

  std::shared_ptr<const ParallelRobot> robot_;
  std::shared_ptr<const LegBases> bases_;
  TouchPairsSettings settings_;
  std::vector<Side> sides_;
};

}  // namespace flinch
