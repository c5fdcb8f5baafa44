#include "tests/peer/mujoco_bench.h"

#include <array>
#include <cmath>
#include <cstring>
#include <sstream>
#include <stdexcept>

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

std::string bench_xml(const PlanarRrrParameters& robot, const LinkBody& link1, const LinkBody& link2) {
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

mjModel* load(const std::string& xml) {
  // MuJoCo reads XML from files, or from its own virtual file system.
  auto files = std::make_unique<mjVFS>();
  mj_defaultVFS(files.get());
  mj_makeEmptyFileVFS(files.get(), "bench.xml", static_cast<int>(xml.size()));
  std::memcpy(files->filedata[0], xml.data(), xml.size());
  std::array<char, 1000> error{};
  mjModel* model = mj_loadXML("bench.xml", files.get(), error.data(), error.size());
  mj_deleteVFS(files.get());
  if (model == nullptr) throw std::runtime_error(error.data());
  return model;
}

}  // namespace

MujocoBench::MujocoBench(const PlanarRrrParameters& robot, const LinkBody& link1, const LinkBody& link2)
    : xml_(bench_xml(robot, link1, link2)),
      model_(load(xml_)),
      data_(mj_makeData(model_.get())),
      probe_(mj_makeData(model_.get())) {
  // The anchor on the platform is where the coupling joint is, not where the legs stand at zero angles.
  for (int i = 0; i < 3; ++i) {
    const PlanarRrrLeg& leg = robot.legs[static_cast<std::size_t>(i)];
    mjtNum* anchors = model_->eq_data + i * mjNEQDATA;
    anchors[3] = robot.coupling_radius * std::cos(leg.coupling_angle);
    anchors[4] = robot.coupling_radius * std::sin(leg.coupling_angle);
    anchors[5] = 0.0;
  }
}

void MujocoBench::set_state(const Eigen::Vector3d& pose, const Eigen::Vector3d& velocity,
                            const std::array<double, 3>& active, const std::array<double, 3>& passive,
                            const std::array<double, 3>& active_rate,
                            const std::array<double, 3>& passive_rate) {
  for (int i = 0; i < 3; ++i) {
    data_->qpos[i] = pose[i];
    data_->qvel[i] = velocity[i];
    const auto leg = static_cast<std::size_t>(i);
    data_->qpos[3 + 2 * i] = active[leg];
    data_->qpos[4 + 2 * i] = passive[leg];
    data_->qvel[3 + 2 * i] = active_rate[leg];
    data_->qvel[4 + 2 * i] = passive_rate[leg];
  }
}

Eigen::MatrixXd MujocoBench::constraint_jacobian(mjData* data) const {
  mj_fwdPosition(model_.get(), data);
  Eigen::MatrixXd jacobian(data->nefc, model_->nv);
  if (mj_isSparse(model_.get()) != 0) {
    throw std::runtime_error("the constraint Jacobian is sparse; the bench is small enough for a dense one");
  }
  for (int row = 0; row < data->nefc; ++row) {
    for (int column = 0; column < model_->nv; ++column)
      jacobian(row, column) = data->efc_J[row * model_->nv + column];
  }
  return jacobian;
}

Eigen::VectorXd MujocoBench::jacobian_rate_times_velocity() const {
  constexpr double h = 1e-6;
  const Eigen::Map<const Eigen::VectorXd> q(data_->qpos, model_->nq);
  const Eigen::Map<const Eigen::VectorXd> v(data_->qvel, model_->nv);
  Eigen::Map<Eigen::VectorXd> probe(probe_->qpos, model_->nq);
  probe = q + h * v;  // all joints are slides and hinges: coordinates and rates agree
  const Eigen::MatrixXd after = constraint_jacobian(probe_.get());
  probe = q - h * v;
  const Eigen::MatrixXd before = constraint_jacobian(probe_.get());
  return (after - before) * v / (2 * h);
}

Eigen::Vector3d MujocoBench::platform_acceleration(const Eigen::Vector3d& drive_torques) {
  mjData* data = data_.get();
  for (int i = 0; i < 3; ++i) data->ctrl[i] = drive_torques[i];
  const Eigen::VectorXd drift = jacobian_rate_times_velocity();
  mj_fwdPosition(model_.get(), data);
  mj_fwdVelocity(model_.get(), data);
  mj_fwdActuation(model_.get(), data);
  mj_fwdAcceleration(model_.get(), data);
  for (int row = 0; row < data->nefc; ++row) data->efc_aref[row] -= drift[row];
  mj_fwdConstraint(model_.get(), data);
  return {data->qacc[0], data->qacc[1], data->qacc[2]};
}

}  // namespace flinch::peer
