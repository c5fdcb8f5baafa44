#include "systems/robot/legs/legs_motion.h"

#include "systems/robot/angles.h"
#include "systems/robot/legs/rest_factor.h"

namespace flinch {
namespace {

using Map = PlatformTwist::Map;

// Columns of a 6 x 6 map of the chart numbers with this role.
Map columns_of(const LegsModel& model, const Eigen::Matrix<double, 6, 6>& X, ChartRole role) {
  Map columns(6, 0);
  for (int i = 0; i < 6; ++i) {
    if (model.moves.roles[static_cast<std::size_t>(i)] != role) continue;
    columns.conservativeResize(Eigen::NoChange, columns.cols() + 1);
    columns.col(columns.cols() - 1) = X.col(i);
  }
  return columns;
}

// The rates of all chart numbers, from those of the free and the following ones.
ChartNumbers chart_rate(const LegsModel& model, const PlatformVector& v, const FollowingVector& z_rate) {
  ChartNumbers rate = ChartNumbers::Zero();
  int next_free = 0;
  int next_following = 0;
  for (int i = 0; i < 6; ++i) {
    const ChartRole role = model.moves.roles[static_cast<std::size_t>(i)];
    if (role == ChartRole::free) rate[i] = v[next_free++];
    if (role == ChartRole::follows) rate[i] = z_rate[next_following++];
  }
  return rate;
}

}  // namespace

void LegMotion::start(const ModelLeg& leg, const LegCoordinates& s) noexcept {
  leg.chain.place(s, place);
  ClosureMatrix J;
  leg.matrix(place, J);
  factor.compute(J);
}

// G = J^+ P
void LegMotion::set_map(const ModelLeg& leg, const PlatformTwist& platform,
                        const PlatformVector& v) noexcept {
  ClosureMap P;
  leg.platform_map(platform, platform.T, P);
  factor.solve(P, G);
  s_rate.noalias() = G.lazyProduct(v);
  leg.chain.rates(place, s_rate, rates);
  ClosureMatrix J;
  leg.matrix(place, rates, J, dJ);
}

// dG = J^+ (dP - dJ G)
void LegMotion::set_map_rate(const ModelLeg& leg, const PlatformTwist& platform) noexcept {
  ClosureMap dP;
  leg.platform_map_rate(platform, platform.T, platform.dT, dP);
  dP -= dJ.lazyProduct(G);
  factor.solve(dP, dG);
}

JointVector drive_positions(const LegsModel& model, const LegsState& state) noexcept {
  JointVector positions(static_cast<Eigen::Index>(model.drives.size()));
  for (std::size_t i = 0; i < model.drives.size(); ++i) {
    const ModelDrive& drive = model.drives[i];
    double position = drive.zero;
    for (const ModelDrive::Term& term : drive.terms) {
      position += term.weight * model.legs[term.leg].chain.joints[term.joint].position(state.s[term.leg]);
    }
    positions[static_cast<Eigen::Index>(i)] =
        drive.kind == DriveKind::revolute ? wrap_angle(position) : position;
  }
  return positions;
}

void set_drive_map(const LegsModel& model, const LegsMotion& motion, PlatformMatrix& A,
                   PlatformMatrix& dA) noexcept {
  const auto m = static_cast<Eigen::Index>(model.drives.size());
  A.setZero(m, motion.platform.T.cols());
  dA.setZero(m, motion.platform.T.cols());
  for (std::size_t i = 0; i < model.drives.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    for (const ModelDrive::Term& term : model.drives[i].terms) {
      const ChainJoint& joint = model.legs[term.leg].chain.joints[term.joint];
      const LegMotion& leg = motion.legs[term.leg];
      A.row(row) += term.weight * joint.ratio * leg.G.row(joint.coordinate);
      dA.row(row) += term.weight * joint.ratio * leg.dG.row(joint.coordinate);
    }
  }
}

void set_twist(const LegsModel& model, const PlatformVector& v, PlatformTwist& platform) noexcept {
  platform.T = columns_of(model, Eigen::Matrix<double, 6, 6>::Identity(), ChartRole::free);
  platform.dT.setZero(6, platform.T.cols());
  platform.twist.noalias() = platform.T.lazyProduct(v);
}

void LegsMotion::set(const LegsModel& model, const Configuration& pose, const PlatformVector& v,
                     const LegsState& state) noexcept {
  set_platform(model, pose, v, state);
  if (model.following() > 0) return;
  for (std::size_t i = 0; i < model.legs.size(); ++i) {
    legs[i].start(model.legs[i], state.s[i]);
    legs[i].set_map(model.legs[i], platform, v);
    legs[i].set_map_rate(model.legs[i], platform);
  }
}

void LegsMotion::set_platform(const LegsModel& model, const Configuration& pose, const PlatformVector& v,
                              const LegsState& state) noexcept {
  if (model.following() > 0) return set_following(model, pose, v, state);
  model.place(pose, state.z, platform);
  set_twist(model, v, platform);
}

void LegsMotion::set_for(const LegsModel& model, const Configuration& pose, const PlatformVector& v,
                         const LegsState& state, std::size_t leg) noexcept {
  set_platform(model, pose, v, state);
  if (model.following() > 0) return;
  legs[leg].start(model.legs[leg], state.s[leg]);
  legs[leg].set_map(model.legs[leg], platform, v);
  legs[leg].set_map_rate(model.legs[leg], platform);
}

// H = -Z^-1 B with Z, B the stacks of N P_z, N P_x; T = X_x + X_z H. dH = -Z^-1 stack N (dP(T, dX_x + dX_z H)
// - dJ G).
void LegsMotion::set_following(const LegsModel& model, const Configuration& pose, const PlatformVector& v,
                               const LegsState& state) noexcept {
  const ChartNumbers chart = model.chart(pose, state.z);
  model.place(chart, platform);
  const Eigen::Matrix<double, 6, 6> X = chart_map(chart);
  const Map X_x = columns_of(model, X, ChartRole::free);
  const Map X_z = columns_of(model, X, ChartRole::follows);
  RestFactor rest;
  rest.start(model.following());
  RestFactor::Rows B(0, X_x.cols());
  for (std::size_t i = 0; i < model.legs.size(); ++i) {
    ClosureMap P;
    legs[i].start(model.legs[i], state.s[i]);
    model.legs[i].platform_map(platform, X_z, P);
    rest.add(legs[i].factor, P);
    model.legs[i].platform_map(platform, X_x, P);
    append_rows(B, legs[i].factor.rest(P));
  }
  rest.factor();
  const RestFactor::Rows H = rest.solve(B);
  platform.T = X_x + X_z.lazyProduct(H);
  platform.twist.noalias() = platform.T.lazyProduct(v);

  const Eigen::Matrix<double, 6, 6> dX = chart_map_rate(chart, chart_rate(model, v, H.lazyProduct(v)));
  platform.dT =
      columns_of(model, dX, ChartRole::free) + columns_of(model, dX, ChartRole::follows).lazyProduct(H);
  B.resize(0, X_x.cols());
  for (std::size_t i = 0; i < model.legs.size(); ++i) {
    legs[i].set_map(model.legs[i], platform, v);
    ClosureMap dP;
    model.legs[i].platform_map_rate(platform, platform.T, platform.dT, dP);
    dP -= legs[i].dJ.lazyProduct(legs[i].G);
    append_rows(B, legs[i].factor.rest(dP));
  }
  platform.dT += X_z.lazyProduct(rest.solve(B));
  for (std::size_t i = 0; i < model.legs.size(); ++i) legs[i].set_map_rate(model.legs[i], platform);
  const bool square = rest.rows() == model.following();
  rest_determinant =
      square ? rest.determinant() / model.home_rest_determinant : rest.size() / model.home_rest_determinant;
}

}  // namespace flinch
