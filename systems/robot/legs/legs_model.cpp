#include "systems/robot/legs/legs_model.h"

#include <numbers>

#include "systems/robot/angles.h"
#include "systems/robot/legs/closure_factor.h"
#include "systems/robot/legs/home_assembly.h"
#include "systems/robot/rotation.h"

namespace flinch {

// ---------------------------------------------------------------- a leg

double ModelLeg::side(const ClosureMatrix& J, double determinant) const noexcept {
  if (side_rows.empty()) return determinant * home_determinant;
  ClosureMatrix chosen(chain.coordinates, chain.coordinates);
  for (int i = 0; i < chain.coordinates; ++i) chosen.row(i) = J.row(side_rows[static_cast<std::size_t>(i)]);
  ClosureFactor factor;
  factor.compute(chosen);
  return factor.determinant() * home_side;
}

void ModelLeg::residual(const ChainPlace& place, const PlatformTwist& platform,
                        ClosureVector& e) const noexcept {
  e.resize(rows);
  int first = 0;
  for (const ChainClosure& closure : closures) {
    closure.residual(place, platform, first, e);
    first += closure.rows();
  }
}

void ModelLeg::matrix(const ChainPlace& place, ClosureMatrix& J) const noexcept {
  J.resize(rows, chain.coordinates);
  int first = 0;
  for (const ChainClosure& closure : closures) {
    closure.rows_of_leg(chain, place, first, J);
    first += closure.rows();
  }
}

void ModelLeg::matrix(const ChainPlace& place, const ChainRates& rates, ClosureMatrix& J,
                      ClosureMatrix& dJ) const noexcept {
  J.resize(rows, chain.coordinates);
  dJ.resize(rows, chain.coordinates);
  int first = 0;
  for (const ChainClosure& closure : closures) {
    closure.rows_of_leg(chain, place, rates, first, J, dJ);
    first += closure.rows();
  }
}

// ---------------------------------------------------------------- the platform

ChartNumbers LegsModel::home_chart() const noexcept {
  ChartNumbers c;
  c << home_position, Eigen::Vector3d::Zero();
  return c;
}

ChartNumbers LegsModel::chart(const Configuration& pose, const FollowingVector& z) const noexcept {
  ChartNumbers c = home_chart();
  if (moves.whole_pose()) {
    const Eigen::Vector4d q = pose.tail<4>();
    c << pose.head<3>(), rotation_log(rotation_matrix(q.normalized()) * home_axes.transpose());
    return c;
  }
  int next_free = 0;
  int next_following = 0;
  for (int i = 0; i < 6; ++i) {
    const ChartRole role = moves.roles[static_cast<std::size_t>(i)];
    if (role == ChartRole::free) c[i] = pose[next_free++];
    if (role == ChartRole::follows) c[i] = z[next_following++];
  }
  if (moves.space.rotations() == 1) c[5] = wrap_angle(c[5] - home_angle);
  return c;
}

void LegsModel::place(const ChartNumbers& chart, PlatformTwist& out) const noexcept {
  out.origin = chart.head<3>();
  out.axes = home_axes;
  if (!chart.tail<3>().isZero(0.0)) out.axes = rotation_exp(chart.tail<3>()) * home_axes;
}

void LegsModel::place(const Configuration& pose, const FollowingVector& z,
                      PlatformTwist& out) const noexcept {
  if (!moves.whole_pose()) return place(chart(pose, z), out);
  const Eigen::Vector4d q = pose.tail<4>();
  out.origin = pose.head<3>();
  out.axes = rotation_matrix(q.normalized());
}

// ---------------------------------------------------------------- from its description

namespace {

/// Where the joints of the description are among those of one axis each.
struct AxesOfJoint {
  std::size_t first = 0;
  std::size_t count = 0;
  std::size_t last() const { return first + count - 1; }
};

std::vector<Eigen::Vector3d> axes_of(const LegJoint& joint) {
  switch (joint.kind) {
    case LegJointKind::universal:
      return {joint.axis, joint.second_axis};
    case LegJointKind::spherical:
      return {Eigen::Vector3d::UnitX(), Eigen::Vector3d::UnitY(), Eigen::Vector3d::UnitZ()};
    case LegJointKind::screw:
      return {joint.axis, joint.axis};
    default:
      return {joint.axis};
  }
}

class ChainBuilder {
 public:
  explicit ChainBuilder(const RobotLeg& leg) : leg_(leg) {
    chain_.base = leg.at;
    chain_.axes = rotation_exp(leg.turned);
    for (std::size_t j = 0; j < leg.joints.size(); ++j) add(j);
  }

  const LegChain& chain() const { return chain_; }
  AxesOfJoint axes(const std::string& name) const {
    return name.empty() ? axes_.back() : axes_[*joint_index(leg_, name)];
  }
  AxesOfJoint axes(std::size_t joint) const { return axes_[joint]; }

 private:
  void add(std::size_t index) {
    const LegJoint& joint = leg_.joints[index];
    const std::vector<Eigen::Vector3d> directions = axes_of(joint);
    axes_.push_back({chain_.joints.size(), directions.size()});
    int parent = -1;
    if (joint.on.empty() && index > 0) parent = static_cast<int>(axes_[index - 1].last());
    if (!joint.on.empty() && joint.on != "base") parent = static_cast<int>(axes(joint.on).last());
    for (std::size_t i = 0; i < directions.size(); ++i) {
      ChainJoint one;
      one.parent = parent;
      one.described = static_cast<int>(index);
      one.at = i == 0 ? joint.at : Eigen::Vector3d(Eigen::Vector3d::Zero());
      one.set_axis(i == 0 ? rotation_exp(joint.turned) : Eigen::Matrix3d(Eigen::Matrix3d::Identity()),
                   directions[i]);
      one.slides = joint.kind == LegJointKind::prismatic || (joint.kind == LegJointKind::screw && i == 1);
      set_coordinate(joint, i, one);
      const bool follows_in_screw = joint.kind == LegJointKind::screw && i == 1;
      if (!follows_in_screw) {
        one.friction = joint.friction;
        one.least = joint.least;
        one.most = joint.most;
      }
      if (joint.drive && i == 0) one.armature = joint.drive->armature;
      if (joint.link && i + 1 == directions.size()) one.link = joint.link->inertia;
      parent = static_cast<int>(chain_.joints.size());
      append(one);
    }
  }

  void set_coordinate(const LegJoint& joint, std::size_t i, ChainJoint& one) {
    if (joint.kind == LegJointKind::screw && i == 1) {
      const ChainJoint& turning = chain_.joints.back();
      const double pitch = joint.pitch / (2.0 * std::numbers::pi);
      one.coordinate = turning.coordinate;
      one.ratio = pitch * turning.ratio;
      one.offset = pitch * turning.offset;
    } else if (joint.follows) {
      const ChainJoint& leader = chain_.joints[axes(joint.follows->joint).first + i];
      one.coordinate = leader.coordinate;
      one.ratio = joint.follows->ratio * leader.ratio;
      one.offset = joint.follows->ratio * leader.offset + joint.follows->offset;
    } else {
      one.coordinate = chain_.coordinates++;
    }
  }

  void append(const ChainJoint& one) {
    std::vector<std::size_t> path;
    if (one.parent >= 0) path = chain_.paths[static_cast<std::size_t>(one.parent)];
    path.push_back(chain_.joints.size());
    chain_.paths.push_back(std::move(path));
    chain_.joints.push_back(one);
  }

  const RobotLeg& leg_;
  LegChain chain_;
  std::vector<AxesOfJoint> axes_;
};

ChainClosure closure_of(const LegClosure& from, const ChainBuilder& builder, bool planar) {
  ChainClosure closure;
  closure.joint = builder.axes(from.joint).last();
  closure.at = from.at;
  closure.turn = rotation_exp(from.turned);
  closure.on = from.on == LegClosure::On::platform ? ChainClosure::On::platform
               : from.on == LegClosure::On::base   ? ChainClosure::On::base
                                                   : ChainClosure::On::joint;
  if (from.on == LegClosure::On::joint) closure.on_joint = builder.axes(from.on_joint).last();
  closure.on_at = from.on_at;
  closure.on_turn = rotation_exp(from.on_turned);
  closure.holds_frame = from.holds_frame;
  closure.planar = planar;
  return closure;
}

// "leg2.shoulder"
std::pair<std::size_t, std::string> leg_and_joint(const std::string& name) {
  const std::size_t dot = name.find('.');
  return {std::stoul(name.substr(3, dot - 3)) - 1, name.substr(dot + 1)};
}

// Of the joints themselves, or by the map.
void add_drives(const LegsParameters& robot, const std::vector<ChainBuilder>& builders, LegsModel& model) {
  const auto kind_of = [](const LegJoint& joint) {
    return slides(joint.kind) ? DriveKind::prismatic : DriveKind::revolute;
  };
  for (std::size_t i = 0; i < robot.legs.size(); ++i) {
    for (std::size_t j = 0; j < robot.legs[i].joints.size(); ++j) {
      const LegJoint& joint = robot.legs[i].joints[j];
      const JointOfLeg place{i, builders[i].axes(j).first};
      if (joint.measured) model.measured.push_back(place);
      if (joint.drive)
        model.drives.push_back({{{place, joint.drive->ratio}}, joint.drive->zero, kind_of(joint)});
    }
  }
  for (const DriveSum& sum : robot.drive_map) {
    ModelDrive drive;
    for (const auto& [name, weight] : sum) {
      const auto [leg, joint] = leg_and_joint(name);
      const std::size_t index = *joint_index(robot.legs[leg], joint);
      drive.kind = kind_of(robot.legs[leg].joints[index]);
      drive.terms.push_back({{leg, builders[leg].axes(index).first}, weight});
    }
    model.drives.push_back(std::move(drive));
  }
}

// The first two links of each leg, those with shapes first.
void add_bodies(const LegsParameters& robot, const std::vector<ChainBuilder>& builders, LegsModel& model) {
  for (std::size_t i = 0; i < robot.legs.size(); ++i) {
    const std::vector<std::size_t> links = bodies_of(robot.legs[i]);
    for (std::size_t k = 0; k < 2; ++k) {
      const std::size_t joint = k < links.size() ? links[k] : robot.legs[i].joints.size() - 1;
      model.bodies.push_back({i, builders[i].axes(joint).last()});
    }
  }
}

LegsModel described(const LegsParameters& robot, std::vector<ChainBuilder>& builders) {
  LegsModel model;
  model.moves = robot.moves;
  model.home_position = robot.home_position;
  model.home_axes = rotation_exp(robot.home_rotation);
  model.home_angle = robot.home_rotation.z();
  model.characteristic_length = robot.characteristic_length;
  model.gravity = robot.gravity;
  if (robot.payload) model.payload = *robot.payload;
  model.platform = robot.payload ? together(robot.platform.inertia, *robot.payload) : robot.platform.inertia;
  for (const RobotLeg& from : robot.legs) {
    const ChainBuilder& builder = builders.emplace_back(from);
    ModelLeg& leg = model.legs.emplace_back();
    leg.chain = builder.chain();
    for (const LegClosure& closure : from.closures) {
      leg.closures.push_back(closure_of(closure, builder, robot.moves.planar));
      leg.rows += leg.closures.back().rows();
    }
    leg.home.setZero(leg.chain.coordinates);
    for (std::size_t j = 0; j < from.joints.size(); ++j) {
      const AxesOfJoint axes = builder.axes(j);
      if (from.joints[j].follows) continue;
      for (std::size_t k = 0; k < axes.count && k < 3; ++k) {
        const ChainJoint& one = leg.chain.joints[axes.first + k];
        const bool of_screw = from.joints[j].kind == LegJointKind::screw && k == 1;
        if (!of_screw) leg.home[one.coordinate] = from.joints[j].reference[k];
      }
    }
  }
  add_drives(robot, builders, model);
  add_bodies(robot, builders, model);
  return model;
}

}  // namespace

AssembledLegs legs_model(const LegsParameters& parameters) {
  AssembledLegs result;
  result.problems = description_problems(parameters);
  if (!result.problems.empty()) return result;
  std::vector<ChainBuilder> builders;
  builders.reserve(parameters.legs.size());
  result.model = described(parameters, builders);
  result.problems = assemble_at_home(parameters, result.model);
  return result;
}

}  // namespace flinch
