#pragma once

#include <Eigen/Dense>
#include <vector>

namespace flinch::test {

/// Forward dynamics by Newton and Euler in maximal coordinates: free bodies in space, held together by joints
/// that are equations of constraint, solved for accelerations and constraint forces at once. It knows nothing
/// of platforms, legs or Jacobians. All points and axes are given in the base frame, at the one instant for
/// which it is set up.
class ConstrainedBodies {
 public:
  using Vector = Eigen::Vector3d;

  static constexpr int base = -1;  ///< The body that does not move.

  /// Index of a body with its centre of mass at `centre` and `inertia` about it in base axes.
  int add_body(double mass, const Vector& centre, const Eigen::Matrix3d& inertia);

  // ------------------------------------------------ joints

  void ball(int a, int b, const Vector& point);
  void revolute(int a, int b, const Vector& point, const Vector& axis);
  /// `axis_of_a` and `axis_of_b` stay across one another.
  void perpendicular(int a, const Vector& axis_of_a, int b, const Vector& axis_of_b);
  /// b slides along `axis` of a and does not turn against it.
  void slider(int a, int b, const Vector& axis, const Vector& point_of_a, const Vector& point_of_b);
  void same_axes(int a, int b);
  /// A mass that is felt by the distance of two points only, as that of a screw between them.
  void screw(int a, const Vector& point_of_a, int b, const Vector& point_of_b, double mass);

  // ------------------------------------------------ motion

  /// Gives `body` its velocity, at `point`; that of all others follows from the joints. Returns by how much
  /// the joints are violated: zero, but for rounding.
  double set_velocity(int body, const Vector& point, const Vector& velocity, const Vector& angular);
  Vector angular_velocity(int body) const;
  Vector velocity(int body, const Vector& point) const;

  // ------------------------------------------------ forces

  void push(int body, const Vector& point, const Vector& force);
  void turn(int body, const Vector& torque);
  void set_gravity(const Vector& gravity) { gravity_ = gravity; }

  /// Accelerations of all bodies under the forces so far.
  void solve();
  Vector angular_acceleration(int body) const { return accelerations_.segment<3>(6 * body + 3); }
  Vector acceleration(int body, const Vector& point) const;

 private:
  struct Body {
    double mass;
    Vector centre;
    Eigen::Matrix3d inertia;
  };
  /// e . (p_b - p_a) = constant, e fixed to `frame`; of a screw, its `mass`.
  struct Distance {
    int frame, a, b;
    Vector e, p_a, p_b;
    double mass = 0.0;
  };
  /// u . w = constant, u fixed to a, w fixed to b.
  struct Angle {
    int a, b;
    Vector u, w;
  };
  /// What a constraint asks: row * accelerations = -drift.
  struct Row {
    Eigen::RowVectorXd row;
    double drift = 0.0;
  };

  Row row_of(const Distance& distance) const;
  Row row_of(const Angle& angle) const;
  std::vector<Row> rows() const;
  Vector arm(int body, const Vector& point) const;
  Vector centripetal(int body, const Vector& point) const;
  int size() const { return 6 * static_cast<int>(bodies_.size()); }

  std::vector<Body> bodies_;
  std::vector<Distance> distances_, screws_;
  std::vector<Angle> angles_;
  Eigen::VectorXd velocities_, forces_, accelerations_;
  Vector gravity_{0.0, 0.0, 0.0};
};

}  // namespace flinch::test
