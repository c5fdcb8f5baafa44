#pragma once

#include <Eigen/Core>
#include <array>
#include <memory>
#include <vector>

#include "systems/contact/touch_places.h"
#include "systems/robot/decompositions.h"
#include "systems/robot/outline.h"
#include "systems/robot/parallel_robot.h"
#include "systems/signals/contact_classes.h"

namespace flinch {

struct TouchTally;

struct TouchHypothesesSettings {
  double force_scale = 50.0;    ///< standard deviation of a contact's force before anything is known [N]
  double object_speed = 0.3;    ///< standard deviation of the velocity of what is touched [m/s]
  double object_radius = 0.03;  ///< of what is touched, to see whether it fits there [m]
  double softness = 0.01;       ///< over which a place between bodies gets too narrow for it [m]
  double closing_speed = 0.1;   ///< standard deviation of how fast something clamped gives way [m/s]
  double friction = 0.15;       ///< coefficients tried: 0, this, and twice this
  int points_along = 36;        ///< tried on each side of a link in the plane, and in the gap of a leg
  int points_around = 72;       ///< tried around the platform in the plane
  int places_in_space = 300;    ///< tried all over the platform in space
  int sides_in_space = 48;      ///< of a link in space, each with so many places:
  int places_along_in_space = 6;
  /// ln of how often a class is touched before its motion is looked at: of platform, first and second links,
  /// and clampings. So that all are equally likely where all are touched equally often.
  double platform_bias = 0.0;
  double link1_bias = 0.0;
  double link2_bias = 0.0;
  double clamping_bias = 0.0;
};

/// Which contact explains a wrench: the physics of being touched as a likelihood.
///
/// Each class is a list of ways to be touched: points on the outline of the body, whose outward normal n and
/// velocity v follow from the model, and friction mu against the sliding. A contact there with a force a >= 0
/// makes the wrench a h, h = J^T u, u = (-n + mu t) / sqrt(1 + mu^2). With noise S of the wrench and a
/// half-normal prior of a with standard deviation s_a, a is marginalised in closed form:
///   p(F) = N(F; 0, S) (2 s / s_a) exp(m^2 / 2 s^2) Phi(m / s),
///   s^-2 = h^T S^-1 h + s_a^-2,   m = s^2 h^T S^-1 F.
/// A way is as likely as things run into it: by E[max(v n - w, 0)] with w ~ N(0, object_speed^2) for objects
/// that may move themselves, and by whether an object fits there without touching another body. Clamping in a
/// leg is touched at both links, as far from the elbow on both, with two forces; it is as likely as the gap
/// closes there.
///
/// In space the platform is tried all over its outline, and closely where the line of action of the wrench
/// meets it, as far around as the noise of the moment leaves open.
///
/// Nothing is trained but the biases of the settings. Legs and bodies may be any number, in the plane or in
/// space; without links that can close on something a leg cannot clamp.
class TouchHypotheses {
 public:
  TouchHypotheses(std::shared_ptr<const ParallelRobot> robot, const TouchHypothesesSettings& settings);

  const ContactClasses& classes() const { return classes_; }

  /// `covariance`: of the wrench. Not valid for kinematics or a wrench that cannot be used. Never allocates.
  void weigh(const Kinematics& kinematics, const PlatformVector& wrench, const PlatformMatrix& covariance,
             ContactEvidence& evidence) const noexcept;

 private:
  /// `count` places from `first` on: one alone, or evenly on a straight line and with one normal.
  struct Side {
    std::size_t first, count;
  };
  /// A whitened wrench, and what makes one of a force or moment in space. Below the platform's coordinates
  /// are zeros: a size that compilers know saves more than they cost.
  using WhitenedWrench = Eigen::Matrix<double, max_dof, 1>;
  using Whitened = Eigen::Matrix<double, max_dof, 3>;
  /// A body in the base frame: how its points move and are felt, and a sphere or capsule that it is to
  /// objects beside it.
  struct Placed {
    Eigen::Vector3d origin, begin, end;
    Eigen::Matrix3d axes;
    Eigen::Vector3d velocity, angular_velocity;  ///< of its origin
    Whitened force, moment;                      ///< on its origin
    double radius = -1.0;                        ///< negative: of another shape, never in the way
    Eigen::Vector3d by_length{0.0, 0.0, 0.0};    ///< from begin to end, over the square of that length

    /// Of the point at `arm` from the origin.
    Eigen::Vector3d velocity_at(const Eigen::Vector3d& arm) const {
      return velocity + angular_velocity.cross(arm);
    }
    WhitenedWrench wrench_of(const Eigen::Vector3d& at_point, const Eigen::Vector3d& arm) const {
      return force * at_point + moment * arm.cross(at_point);
    }
  };
  struct Scene;
  struct Touch;

  void add_places(BodyId body);
  void place(const Kinematics& kinematics, const Eigen::LLT<PlatformMatrix>& S, BodyId body,
             Placed& placed) const;
  void add(const Scene& scene, BodyId body, const TouchPlace& place, const Touch& touch,
           TouchTally& tally) const;
  void weigh_side(const Scene& scene, BodyId body, const Side& side, TouchTally& tally) const;
  void weigh_place(const Scene& scene, BodyId body, const TouchPlace& place, TouchTally& tally) const;
  void weigh_body(const Scene& scene, BodyId body, TouchTally& tally) const;
  void weigh_platform(const Scene& scene, TouchTally& tally) const;
  void weigh_clamping(const Scene& scene, int leg, TouchTally& tally) const;
  double room(const Scene& scene, int body, int neighbour, const Eigen::Vector3d& centre) const;
  double bias(int number) const;

  std::shared_ptr<const ParallelRobot> robot_;
  TouchHypothesesSettings settings_;
  ContactClasses classes_;
  std::vector<std::vector<TouchPlace>> places_;  ///< of each body
  std::vector<std::vector<Side>> sides_;         ///< of these
  Outline platform_;
  double area_each_ = 0.0;  ///< of the platform in space, that a place stands for [m^2]
};

}  // namespace flinch
