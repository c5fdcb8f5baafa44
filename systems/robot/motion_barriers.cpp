#include "systems/robot/motion_barriers.h"

#include <cmath>
#include <limits>

#include "systems/robot/constraint_tasks.h"
#include "systems/robot/reaction_tasks.h"

namespace flinch {
namespace {

constexpr double step_of_differences = 2e-5;  // [m or rad]

/// Adds barriers of one instant.
class Builder {
 public:
  Builder(const Mechanism& mechanism, const Kinematics& kinematics, BarrierList& list)
      : mechanism_(mechanism), kinematics_(kinematics), list_(list) {
    evaluate_nearby(mechanism, kinematics, nearby_);
  }

  void condition_number(double largest) {
    below(BarrierKind::condition_number, smooth_condition_number_task(mechanism_, kinematics_, nearby_),
          std::log(largest));
  }

  void determinants(double least_A, double least_B) {
    if (!(least_A > 0.0) && !(least_B > 0.0)) return;
    const auto closed_form = mechanism_.determinant_gradients(kinematics_);
    const DeterminantGradients gradients = closed_form ? *closed_form : by_differences();
    if (least_B > 0.0)
      add(BarrierKind::type_1_singularity, log_ratio(kinematics_.det_B, least_B), gradients.log_B,
          log_drift(kinematics_.det_B, &PlaceKinematics::det_B));
    if (least_A > 0.0)
      add(BarrierKind::type_2_singularity, log_ratio(kinematics_.det_A, least_A), gradients.log_A,
          log_drift(kinematics_.det_A, &PlaceKinematics::det_A));
  }

  void self_collision(double least, const LimitMargins& margins) {
    const SelfCollisionTasks smooth = mechanism_.self_collision_tasks(kinematics_, least);
    for (int i = 0; i < smooth.count; ++i) {
      below(BarrierKind::self_collision, smooth.tasks[static_cast<std::size_t>(i)],
            smooth.largest - margins.angle);
    }
    if (smooth.count > 0 || mechanism_.description().self_collision_pairs.empty()) return;
    above(BarrierKind::self_collision, self_collision_task(mechanism_, kinematics_, nearby_),
          (1.0 + margins.share) * least);
  }

  /// (R^2 - r^2) / 2R: R - r near the limit, and without the kink that r has in the centre.
  void distance(const CartesianVector& centre, double largest) {
    const int d = mechanism_.space().translations();
    PlatformVector from_centre = PlatformVector::Zero(mechanism_.dof());
    from_centre.head(d) = kinematics_.pose.head(d);
    if (centre.size() == d) from_centre.head(d) -= centre;
    const double speed = kinematics_.velocity.head(d).norm();
    add(BarrierKind::distance, (largest * largest - from_centre.squaredNorm()) / (2.0 * largest),
        -from_centre / largest, -speed * speed / largest);
  }

  /// About one axis, both ways. About three (T^2 - theta^2) / 2T with the rotation vector theta n: dtheta =
  /// n^T omega, and the share of omega across n turns the axis by cot(theta / 2) / 2 of it.
  void rotation(double largest) {
    const ConfigurationSpace& space = mechanism_.space();
    const int rotations = space.rotations();
    if (rotations == 0) return;
    PlatformVector from_base = space.difference(kinematics_.pose, space.origin());
    from_base.head(space.translations()).setZero();
    const double theta = from_base.norm();
    if (rotations == 1) {
      const PlatformVector way = PlatformVector::Unit(mechanism_.dof(), mechanism_.dof() - 1);
      add(BarrierKind::rotation, largest - from_base.sum(), -way, 0.0);
      add(BarrierKind::rotation, largest + from_base.sum(), way, 0.0);
      return;
    }
    const double speed = kinematics_.velocity.tail(rotations).norm();
    const double along = theta > 1e-6 ? from_base.dot(kinematics_.velocity) / theta : speed;
    const double turning = theta > 1e-6 ? 0.5 * theta / std::tan(0.5 * theta) : 1.0;
    add(BarrierKind::rotation, (largest * largest - theta * theta) / (2.0 * largest), -from_base / largest,
        -(along * along + turning * (speed * speed - along * along)) / largest);
  }

  void drive_ranges(double least, double largest) {
    for (int drive = 0; drive < mechanism_.drives(); ++drive) {
      const Task task = drive_task(kinematics_, drive);
      if (std::isfinite(least)) above(BarrierKind::drive_range, task, least);
      if (std::isfinite(largest)) below(BarrierKind::drive_range, task, largest);
    }
  }

 private:
  void add(BarrierKind kind, double room, const PlatformVector& gradient, double drift) {
    list_.add({kind, room, gradient, drift});
    list_.valid = list_.valid && std::isfinite(room) && gradient.allFinite() && std::isfinite(drift);
  }
  void below(BarrierKind kind, const Task& task, double limit) {
    list_.valid = list_.valid && task.valid;
    add(kind, limit - task.sigma[0], -task.J.row(0).transpose(), -task.drift[0]);
  }
  void above(BarrierKind kind, const Task& task, double limit) {
    list_.valid = list_.valid && task.valid;
    add(kind, task.sigma[0] - limit, task.J.row(0).transpose(), task.drift[0]);
  }

  /// Mechanisms scale their determinants as they like, so that nothing else is known of all of them.
  DeterminantGradients by_differences() const {
    const int n = mechanism_.dof();
    DeterminantGradients gradients{PlatformVector::Zero(n), PlatformVector::Zero(n)};
    PlaceKinematics before, after;
    for (int axis = 0; axis < n; ++axis) {
      const PlatformVector moved = step_of_differences * PlatformVector::Unit(n, axis);
      mechanism_.place(mechanism_.space().plus(kinematics_.pose, -moved), before);
      mechanism_.place(mechanism_.space().plus(kinematics_.pose, moved), after);
      gradients.log_A[axis] = log_ratio(after.det_A, before.det_A) / (2.0 * step_of_differences);
      gradients.log_B[axis] = log_ratio(after.det_B, before.det_B) / (2.0 * step_of_differences);
    }
    return gradients;
  }
  static double log_ratio(double a, double b) { return std::log(std::abs(a / b)); }
  double log_drift(double now, double PlaceKinematics::*det) const {
    if (!(nearby_.step > 0.0)) return 0.0;
    return (log_ratio(nearby_.after.*det, now) + log_ratio(nearby_.before.*det, now)) /
           (nearby_.step * nearby_.step);
  }

  const Mechanism& mechanism_;
  const Kinematics& kinematics_;
  BarrierList& list_;
  NearbyPlaces nearby_;
};

}  // namespace

void evaluate_barriers(const Mechanism& mechanism, const Kinematics& kinematics,
                       const PoseConstraints& limits, const LimitMargins& margins,
                       BarrierList& out) noexcept {
  out.count = 0;
  out.valid = kinematics.valid;
  if (!kinematics.valid) return;
  const WorkspaceLimits& workspace = limits.workspace;
  Builder barriers(mechanism, kinematics, out);
  if (std::isfinite(limits.max_condition_number))
    barriers.condition_number(limits.max_condition_number - margins.condition_number);
  barriers.determinants((1.0 + margins.share) * workspace.min_abs_det_A,
                        (1.0 + margins.share) * workspace.min_abs_det_B);
  if (workspace.min_self_collision_distance > 0.0)
    barriers.self_collision(workspace.min_self_collision_distance, margins);
  if (std::isfinite(workspace.max_distance))
    barriers.distance(workspace.centre, workspace.max_distance - margins.distance);
  if (std::isfinite(workspace.max_rotation)) barriers.rotation(workspace.max_rotation - margins.angle);
  const double width = workspace.max_active - workspace.min_active;
  const double margin = std::isfinite(width) ? margins.range * width : 0.0;
  barriers.drive_ranges(workspace.min_active + margin, workspace.max_active - margin);
}

}  // namespace flinch
