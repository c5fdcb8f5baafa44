#include "tests/peer/mujoco_hexapod.h"

#include <Eigen/Geometry>
#include <cmath>
#include <cstddef>
#include <sstream>

#include "systems/robot/rotation.h"

namespace flinch::peer {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

std::ostream& operator<<(std::ostream& out, const Vector3d& v) {
  return out << v.x() << ' ' << v.y() << ' ' << v.z();
}

// e_2 x s, e_2, s: the leg's axes with the second axis of the universal joint across the first.
Matrix3d leg_axes(const Vector3d& first_axis, const Vector3d& s) {
  const Vector3d second = first_axis.cross(s).normalized();
  Matrix3d axes;
  axes << second.cross(s), second, s;
  return axes;
}

// Angle about `axis` from one vector to another, both across it.
double angle(const Vector3d& axis, const Vector3d& from, const Vector3d& to) {
  return std::atan2(axis.dot(from.cross(to)), from.dot(to));
}

std::string inertial(const RigidBodyInertia& body) {
  std::ostringstream text;
  text.precision(17);
  const Matrix3d& I = body.inertia;
  text << "<inertial pos='" << body.centre_of_mass << "' mass='" << body.mass << "' fullinertia='" << I(0, 0)
       << ' ' << I(1, 1) << ' ' << I(2, 2) << ' ' << I(0, 1) << ' ' << I(0, 2) << ' ' << I(1, 2) << "'/>";
  return text.str();
}

std::array<Matrix3d, 6> axes_at_home(const Hexapod& robot) {
  std::array<Matrix3d, 6> axes;
  for (std::size_t i = 0; i < axes.size(); ++i) {
    const HexapodLeg& leg = robot.parameters().legs[i];
    const Vector3d end = robot.parameters().home_position + leg.platform_joint;
    axes[i] = leg_axes(leg.universal_axis, (end - leg.base_joint).normalized());
  }
  return axes;
}

std::string leg_xml(const HexapodParameters& p, std::size_t i, const Matrix3d& axes) {
  const HexapodLeg& leg = p.legs[i];
  const Eigen::Quaterniond turned(axes);
  std::ostringstream text;
  text.precision(17);
  text << "<body name='cylinder" << i << "' pos='" << leg.base_joint << "' quat='" << turned.w() << ' '
       << turned.x() << ' ' << turned.y() << ' ' << turned.z() << "'><joint type='hinge' axis='"
       << Vector3d(axes.transpose() * leg.universal_axis) << "' damping='" << leg.universal_friction.viscous
       << "'/><joint type='hinge' axis='0 1 0' damping='" << leg.universal_friction.viscous << "'/>"
       << inertial(scaled(p.cylinder, leg.mass_scale)) << "<body name='rod" << i << "'><joint name='q" << i
       << "' type='slide' axis='0 0 1' damping='" << leg.drive_friction.viscous << "'/>"
       << inertial(scaled(p.rod, leg.mass_scale)) << "</body></body>";
  return text.str();
}

std::string hexapod_xml(const HexapodParameters& p, const std::array<Matrix3d, 6>& axes) {
  const RigidBodyInertia platform = p.payload ? together(p.platform, *p.payload) : p.platform;
  std::ostringstream text;
  text.precision(17);
  text << "<mujoco><compiler angle='radian' autolimits='true'/><option timestep='0.001' integrator='RK4' "
       << "jacobian='dense' tolerance='1e-14' iterations='200' solver='Newton' gravity='" << p.gravity
       << "'/><worldbody><body name='platform'><freejoint/>" << inertial(platform) << "</body>";
  for (std::size_t i = 0; i < 6; ++i) text << leg_xml(p, i, axes[i]);
  text << "</worldbody><equality>";
  for (std::size_t i = 0; i < 6; ++i) {
    text << "<connect body1='platform' body2='rod" << i << "' anchor='" << p.legs[i].platform_joint
         << "' solref='0.004 1' solimp='0.9999 0.9999 0.001'/>";
  }
  text << "</equality><actuator>";
  for (std::size_t i = 0; i < 6; ++i) text << "<motor joint='q" << i << "'/>";
  text << "</actuator></mujoco>";
  return text.str();
}

}  // namespace

MujocoHexapod::MujocoHexapod(const Hexapod& robot)
    : robot_(robot),
      axes_at_zero_(axes_at_home(robot)),
      mujoco_(hexapod_xml(robot.parameters(), axes_at_zero_)) {
  // The anchor on a rod is its end, not where the platform's joint is while all joints are at zero.
  for (int i = 0; i < 6; ++i) Eigen::Map<Vector3d>(mujoco_.model()->eq_data + i * mjNEQDATA + 3).setZero();
}

// Joints of leg i: positions after the seven numbers of the platform, rates after its six.
void MujocoHexapod::set_leg(int i, const Kinematics& kinematics) {
  const auto index = static_cast<std::size_t>(i);
  const Vector3d k = robot_.parameters().legs[index].universal_axis;
  const LegPoints& points = kinematics.legs[index];
  const Vector3d s = Vector3d(points.coupling_joint - points.base_joint).normalized();
  const Matrix3d& zero = axes_at_zero_[index];
  const Vector3d second = leg_axes(k, s).col(1);
  const double first_angle = angle(k, zero.col(1), second);
  const Vector3d before_second = Eigen::AngleAxisd(first_angle, k) * zero.col(2);
  const ContactJacobian turning = robot_.contact_jacobian(kinematics, BodyId::link1(i), Vector3d::Zero());
  const Vector3d omega = turning.rotation * kinematics.velocity;

  mjtNum* position = mujoco_.data()->qpos + 7 + 3 * i;
  mjtNum* rate = mujoco_.data()->qvel + 6 + 3 * i;
  position[0] = first_angle;
  position[1] = angle(second, before_second, s);
  position[2] = kinematics.joints.active[i];
  rate[0] = omega.dot(k);
  rate[1] = omega.dot(second);
  rate[2] = kinematics.rates.active[i];
}

// MuJoCo counts angular velocities of free bodies in their own axes.
Eigen::Matrix<double, 6, 1> MujocoHexapod::platform_acceleration(
    const Kinematics& kinematics, const Eigen::Matrix<double, 6, 1>& drive_forces) {
  const Matrix3d R = rotation_matrix(kinematics.pose.tail<4>());
  mjData* data = mujoco_.data();
  Eigen::Map<Eigen::Matrix<double, 7, 1>>(data->qpos) = kinematics.pose;
  Eigen::Map<Vector3d>(data->qvel) = kinematics.velocity.head<3>();
  Eigen::Map<Vector3d>(data->qvel + 3) = R.transpose() * kinematics.velocity.tail<3>();
  for (int i = 0; i < 6; ++i) set_leg(i, kinematics);
  Eigen::Map<Eigen::Matrix<double, 6, 1>>(data->ctrl) = drive_forces;
  const Eigen::VectorXd joints = mujoco_.acceleration();
  Eigen::Matrix<double, 6, 1> platform;
  platform << joints.head<3>(), R * joints.segment<3>(3);
  return platform;
}

}  // namespace flinch::peer
