#include "tests/systems/robot/constrained_bodies.h"

namespace flinch::test {

using Vector = Eigen::Vector3d;

int ConstrainedBodies::add_body(double mass, const Vector& centre, const Eigen::Matrix3d& inertia) {
  bodies_.push_back({mass, centre, inertia});
  velocities_.setZero(size());
  forces_.setZero(size());
  return static_cast<int>(bodies_.size()) - 1;
}

// ---------------------------------------------------------------- joints

void ConstrainedBodies::ball(int a, int b, const Vector& point) {
  for (int axis = 0; axis < 3; ++axis) distances_.push_back({base, a, b, Vector::Unit(axis), point, point});
}

void ConstrainedBodies::perpendicular(int a, const Vector& axis_of_a, int b, const Vector& axis_of_b) {
  angles_.push_back({a, b, axis_of_a, axis_of_b});
}

void ConstrainedBodies::revolute(int a, int b, const Vector& point, const Vector& axis) {
  ball(a, b, point);
  const Vector across = axis.unitOrthogonal();
  perpendicular(a, across, b, axis);
  perpendicular(a, axis.cross(across), b, axis);
}

void ConstrainedBodies::same_axes(int a, int b) {
  perpendicular(a, Vector::UnitX(), b, Vector::UnitY());
  perpendicular(a, Vector::UnitY(), b, Vector::UnitZ());
  perpendicular(a, Vector::UnitZ(), b, Vector::UnitX());
}

void ConstrainedBodies::slider(int a, int b, const Vector& axis, const Vector& point_of_a,
                               const Vector& point_of_b) {
  same_axes(a, b);
  const Vector across = axis.unitOrthogonal();
  distances_.push_back({a, a, b, across, point_of_a, point_of_b});
  distances_.push_back({a, a, b, axis.cross(across), point_of_a, point_of_b});
}

void ConstrainedBodies::screw(int a, const Vector& point_of_a, int b, const Vector& point_of_b, double mass) {
  screws_.push_back({base, a, b, (point_of_b - point_of_a).normalized(), point_of_a, point_of_b, mass});
}

// ---------------------------------------------------------------- motion

Vector ConstrainedBodies::arm(int body, const Vector& point) const {
  return body == base ? Vector(0, 0, 0) : Vector(point - bodies_[static_cast<std::size_t>(body)].centre);
}

Vector ConstrainedBodies::angular_velocity(int body) const {
  return body == base ? Vector(0, 0, 0) : Vector(velocities_.segment<3>(6 * body + 3));
}

Vector ConstrainedBodies::velocity(int body, const Vector& point) const {
  if (body == base) return {0, 0, 0};
  return velocities_.segment<3>(6 * body) + angular_velocity(body).cross(arm(body, point));
}

Vector ConstrainedBodies::centripetal(int body, const Vector& point) const {
  const Vector omega = angular_velocity(body);
  return omega.cross(omega.cross(arm(body, point)));
}

Vector ConstrainedBodies::acceleration(int body, const Vector& point) const {
  return accelerations_.segment<3>(6 * body) + angular_acceleration(body).cross(arm(body, point)) +
         centripetal(body, point);
}

double ConstrainedBodies::set_velocity(int body, const Vector& point, const Vector& velocity,
                                       const Vector& angular) {
  velocities_.setZero();
  velocities_.segment<3>(6 * body) = velocity - angular.cross(arm(body, point));
  velocities_.segment<3>(6 * body + 3) = angular;
  const std::vector<Row> constraints = rows();
  Eigen::MatrixXd J(constraints.size(), size());
  for (int i = 0; i < J.rows(); ++i) J.row(i) = constraints[static_cast<std::size_t>(i)].row;
  const Eigen::VectorXd violation = J * velocities_;
  Eigen::MatrixXd J_others = J;
  J_others.middleCols<6>(6 * body).setZero();
  const Eigen::VectorXd others = J_others.completeOrthogonalDecomposition().solve(-violation);
  velocities_ += others;
  return (J * velocities_).lpNorm<Eigen::Infinity>();
}

// ---------------------------------------------------------------- dynamics

void ConstrainedBodies::push(int body, const Vector& point, const Vector& force) {
  if (body == base) return;
  forces_.segment<3>(6 * body) += force;
  forces_.segment<3>(6 * body + 3) += arm(body, point).cross(force);
}

void ConstrainedBodies::turn(int body, const Vector& torque) {
  if (body != base) forces_.segment<3>(6 * body + 3) += torque;
}

ConstrainedBodies::Row ConstrainedBodies::row_of(const Distance& d) const {
  Row result{Eigen::RowVectorXd::Zero(size())};
  const auto add_point = [&](int body, const Vector& point, double sign) {
    if (body == base) return;
    result.row.segment<3>(6 * body) += sign * d.e;
    result.row.segment<3>(6 * body + 3) += sign * arm(body, point).cross(d.e);
    result.drift += sign * d.e.dot(centripetal(body, point));
  };
  add_point(d.b, d.p_b, 1.0);
  add_point(d.a, d.p_a, -1.0);
  if (d.frame != base) {
    const Vector between = d.p_b - d.p_a;
    const Vector omega = angular_velocity(d.frame);
    result.row.segment<3>(6 * d.frame + 3) += d.e.cross(between);
    result.drift += 2.0 * omega.cross(d.e).dot(velocity(d.b, d.p_b) - velocity(d.a, d.p_a)) +
                    omega.cross(omega.cross(d.e)).dot(between);
  }
  return result;
}

ConstrainedBodies::Row ConstrainedBodies::row_of(const Angle& angle) const {
  Row result{Eigen::RowVectorXd::Zero(size())};
  const Vector omega_a = angular_velocity(angle.a);
  const Vector omega_b = angular_velocity(angle.b);
  const Vector n = angle.u.cross(angle.w);
  const Vector n_rate = omega_a.cross(angle.u).cross(angle.w) + angle.u.cross(omega_b.cross(angle.w));
  if (angle.a != base) result.row.segment<3>(6 * angle.a + 3) += n;
  if (angle.b != base) result.row.segment<3>(6 * angle.b + 3) -= n;
  result.drift = n_rate.dot(omega_a - omega_b);
  return result;
}

std::vector<ConstrainedBodies::Row> ConstrainedBodies::rows() const {
  std::vector<Row> rows;
  for (const Distance& distance : distances_) rows.push_back(row_of(distance));
  for (const Angle& angle : angles_) rows.push_back(row_of(angle));
  return rows;
}

// [M, -J^T; J, 0] (a, lambda) = (forces, -drift). Joints of planar robots are redundant in space: the
// accelerations are determined nonetheless.
void ConstrainedBodies::solve() {
  const std::vector<Row> constraints = rows();
  const int n = size();
  const int m = static_cast<int>(constraints.size());
  Eigen::MatrixXd system = Eigen::MatrixXd::Zero(n + m, n + m);
  Eigen::VectorXd right(n + m);
  right.head(n) = forces_;
  for (int i = 0; i < n / 6; ++i) {
    const Body& body = bodies_[static_cast<std::size_t>(i)];
    const Vector omega = angular_velocity(i);
    system.block<3, 3>(6 * i, 6 * i) = body.mass * Eigen::Matrix3d::Identity();
    system.block<3, 3>(6 * i + 3, 6 * i + 3) = body.inertia;
    right.segment<3>(6 * i) += body.mass * gravity_;
    right.segment<3>(6 * i + 3) -= omega.cross(body.inertia * omega);
  }
  for (const Distance& screw : screws_) {
    const Row row = row_of(screw);
    const Vector rate = velocity(screw.b, screw.p_b) - velocity(screw.a, screw.p_a);
    const Vector across = rate - screw.e.dot(rate) * screw.e;
    const double drift = row.drift + across.squaredNorm() / (screw.p_b - screw.p_a).norm();
    system.topLeftCorner(n, n) += screw.mass * row.row.transpose() * row.row;
    right.head(n) -= screw.mass * drift * row.row.transpose();
  }
  for (int i = 0; i < m; ++i) {
    const Row& constraint = constraints[static_cast<std::size_t>(i)];
    system.block(n + i, 0, 1, n) = constraint.row;
    system.block(0, n + i, n, 1) = -constraint.row.transpose();
    right[n + i] = -constraint.drift;
  }
  accelerations_ = system.completeOrthogonalDecomposition().solve(right).head(n);
}

}  // namespace flinch::test
