#include "tests/peer/mujoco_rig.h"

#include <array>
#include <cmath>
#include <sstream>

namespace flinch::peer {
namespace {

std::string inertial(double x, double mass, double inertia) {
  // MuJoCo wants a full positive definite inertia that obeys the triangle inequality; only the z part matters
  // here.
  std::ostringstream text;
  text.precision(17);
  text << "<inertial pos='" << x << " 0 0' mass='" << mass << "' diaginertia='" << inertia << " " << inertia
       << " " << inertia << "'/>";
  return text.str();
}

std::string leg_xml(const PlanarRrrLeg& leg, int i, const LinkBody& link1, const LinkBody& link2) {
  std::ostringstream text;
  text.precision(17);
  const double x = leg.base_radius * std::sin(leg.base_angle);
  const double y = -leg.base_radius * std::cos(leg.base_angle);
  text << "<body name='leg" << i << "_link1' pos='" << x << " " << y << " 0' euler='0 0 " << leg.base_angle
       << "'>"
       << "<joint name='qa" << i << "' type='hinge' axis='0 0 1' damping='" << leg.active_friction.viscous
       << "'/>" << inertial(link1.centre_of_mass, link1.mass, link1.inertia) << "<body name='leg" << i
       << "_link2' pos='" << leg.link1_length << " 0 0'>"
       << "<joint name='qp" << i << "' type='hinge' axis='0 0 1' damping='" << leg.passive_friction.viscous
       << "'/>" << inertial(link2.centre_of_mass, link2.mass, link2.inertia) << "</body></body>";
  return text.str();
}

std::string rig_xml(const PlanarRrrParameters& robot, const LinkBody& link1, const LinkBody& link2) {
  std::ostringstream text;
  text.precision(17);
  text << "<mujoco><compiler angle='radian' autolimits='true'/>"
       << "<option timestep='0.001' integrator='RK4' gravity='0 0 -9.81' tolerance='1e-14' iterations='200' "
          "solver='Newton'/>"
       << "<worldbody><body name='platform'><joint name='x' type='slide' axis='1 0 0'/>"
       << "<joint name='y' type='slide' axis='0 1 0'/><joint name='phi' type='hinge' axis='0 0 1'/>"
       << inertial(0.0, robot.platform_mass, robot.platform_inertia) << "</body>";
  for (int i = 0; i < 3; ++i) text << leg_xml(robot.legs[static_cast<std::size_t>(i)], i, link1, link2);
  text << "</worldbody><equality>";
  for (int i = 0; i < 3; ++i) {
    const double length = robot.legs[static_cast<std::size_t>(i)].link2_length;
    text << "<connect body1='leg" << i << "_link2' body2='platform' anchor='" << length
         << " 0 0' solref='0.004 1' solimp='0.9999 0.9999 0.001'/>";
  }
  text << "</equality><actuator>";
  for (int i = 0; i < 3; ++i) text << "<motor joint='qa" << i << "'/>";
  text << "</actuator></mujoco>";
  return text.str();
}

}  // namespace

MujocoRig::MujocoRig(const PlanarRrrParameters& robot, const LinkBody& link1, const LinkBody& link2)
    : xml_(rig_xml(robot, link1, link2)), mujoco_(xml_) {
  // The anchor on the platform is where the coupling joint is, not where the legs stand at zero angles.
  for (int i = 0; i < 3; ++i) {
    const PlanarRrrLeg& leg = robot.legs[static_cast<std::size_t>(i)];
    mjtNum* anchors = model()->eq_data + i * mjNEQDATA;
    anchors[3] = robot.coupling_radius * std::cos(leg.coupling_angle);
    anchors[4] = robot.coupling_radius * std::sin(leg.coupling_angle);
    anchors[5] = 0.0;
  }
}

void MujocoRig::set_state(const Eigen::Vector3d& pose, const Eigen::Vector3d& velocity,
                          const std::array<double, 3>& active, const std::array<double, 3>& passive,
                          const std::array<double, 3>& active_rate,
                          const std::array<double, 3>& passive_rate) {
  for (int i = 0; i < 3; ++i) {
    data()->qpos[i] = pose[i];
    data()->qvel[i] = velocity[i];
    const auto leg = static_cast<std::size_t>(i);
    data()->qpos[3 + 2 * i] = active[leg];
    data()->qpos[4 + 2 * i] = passive[leg];
    data()->qvel[3 + 2 * i] = active_rate[leg];
    data()->qvel[4 + 2 * i] = passive_rate[leg];
  }
}

Eigen::Vector3d MujocoRig::platform_acceleration(const Eigen::Vector3d& drive_torques) {
  for (int i = 0; i < 3; ++i) data()->ctrl[i] = drive_torques[i];
  return mujoco_.acceleration().head<3>();
}

}  // namespace flinch::peer
