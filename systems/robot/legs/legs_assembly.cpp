#include "systems/robot/legs/legs_assembly.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "systems/robot/angles.h"
#include "systems/robot/legs/rest_factor.h"

namespace flinch {
namespace {

constexpr int max_steps = 6;            // of Newton's method at one place
constexpr int max_steps_of_path = 400;  // and on the whole path
constexpr double last_step = 3e-9;      // after it the error is its square
constexpr double longest_step = 0.3;    // [rad or m]
constexpr double longest_step_of_approach = 0.2;
constexpr double slowest = 0.25;  // of a step to the one before
constexpr double rounding = 1e-12;
constexpr double largest_rest = 1e-7;   // by which redundant rows may stay open [m or rad]
constexpr double shortest_part = 1e-3;  // of a path

using Columns = Eigen::Matrix<double, 6, Eigen::Dynamic, 0, 6, max_dof>;

// Columns of X of the chart numbers with this role.
Columns chart_columns(const LegsModel& model, const ChartNumbers& chart, ChartRole role) {
  const Eigen::Matrix<double, 6, 6> X = chart_map(chart);
  Columns columns(6, 0);
  for (int i = 0; i < 6; ++i) {
    if (model.moves.roles[static_cast<std::size_t>(i)] != role) continue;
    columns.conservativeResize(Eigen::NoChange, columns.cols() + 1);
    columns.col(columns.cols() - 1) = X.col(i);
  }
  return columns;
}

ChartNumbers with_following(const LegsModel& model, ChartNumbers chart, const FollowingVector& z) {
  int next = 0;
  for (int i = 0; i < 6; ++i) {
    if (model.moves.roles[static_cast<std::size_t>(i)] == ChartRole::follows) chart[i] = z[next++];
  }
  return chart;
}

// Of one leg at a place: what Newton's method needs.
struct OpenLeg {
  ClosureFactor factor;
  double side = 1.0;  ///< As ModelLeg tells it.
  ClosureVector e;
  ClosureMap P_z;
};

bool is_within_range(const LegChain& chain, const LegCoordinates& s) {
  return std::all_of(chain.joints.begin(), chain.joints.end(), [&](const ChainJoint& joint) {
    const double q = joint.slides ? joint.position(s) : wrap_angle(joint.position(s));
    return q > joint.least && q < joint.most;
  });
}

// How a Newton step, or the tangent of a path, moves legs and what follows so that e + P_z dz = J ds.
struct Step {
  std::array<LegCoordinates, max_dof> s;
  FollowingVector z;

  double size(LegRange legs) const {
    double largest = z.size() > 0 ? z.lpNorm<Eigen::Infinity>() : 0.0;
    for (std::size_t i = legs.first; i < legs.end; ++i) {
      const double of_leg = s[i].lpNorm<Eigen::Infinity>();
      if (!(of_leg <= largest)) largest = of_leg;
    }
    return largest;
  }
};

void advance(LegRange legs, double share, const Step& step, LegsState& state) {
  for (std::size_t i = legs.first; i < legs.end; ++i) state.s[i] += share * step.s[i];
  state.z += share * step.z;
}

class Newton {
 public:
  Newton(const LegsModel& model, LegRange legs) : model_(model), legs_(legs) {}

  /// Factors the legs at `state`; `e` is their residual, or what `rows` says instead.
  template <class RowsOfLeg>
  void factor(const ChartNumbers& chart, const LegsState& state, RowsOfLeg&& rows) {
    const ChartNumbers whole = with_following(model_, chart, state.z);
    model_.place(whole, platform_);
    rest_.start(model_.following());
    const Columns X_z = chart_columns(model_, whole, ChartRole::follows);
    for (std::size_t i = legs_.first; i < legs_.end; ++i) {
      const ModelLeg& leg = model_.legs[i];
      ChainPlace place;
      ClosureMatrix J;
      leg.chain.place(state.s[i], place);
      leg.matrix(place, J);
      open_[i].factor.compute(J);
      open_[i].side = leg.side(J, open_[i].factor.determinant());
      rows(leg, place, whole, open_[i].e);
      leg.platform_map(platform_, X_z, open_[i].P_z);
      if (model_.following() > 0) rest_.add(open_[i].factor, open_[i].P_z);
    }
    if (model_.following() > 0) rest_.factor();
  }

  Step step() const {
    Step step;
    step.z.setZero(model_.following());
    if (model_.following() > 0) step.z = rest_.solve(rest_of_legs());
    for (std::size_t i = legs_.first; i < legs_.end; ++i) {
      const ClosureVector e = open_[i].e + open_[i].P_z.lazyProduct(step.z);
      open_[i].factor.solve(e, step.s[i]);
    }
    return step;
  }

  /// Largest of the rows that no step closes.
  double rest(const Step& step) const {
    double largest = 0.0;
    for (std::size_t i = legs_.first; i < legs_.end; ++i) {
      if (open_[i].factor.rest_rows() == 0) continue;
      const ClosureVector e = open_[i].e + open_[i].P_z.lazyProduct(step.z);
      largest = std::max(largest, open_[i].factor.rest(e).lpNorm<Eigen::Infinity>());
    }
    return largest;
  }

  bool keeps_signs() const {
    const bool whole = model_.following() > 0 && rest_.rows() == model_.following();
    if (whole) return rest_.determinant() * model_.home_rest_determinant > 0.0;
    for (std::size_t i = legs_.first; i < legs_.end; ++i) {
      if (!(open_[i].side > 0.0)) return false;
    }
    return true;
  }

  const PlatformTwist& platform() const { return platform_; }

 private:
  RestFactor::Rows rest_of_legs() const {
    RestFactor::Rows b(0, 1);
    for (std::size_t i = legs_.first; i < legs_.end; ++i) append_rows(b, open_[i].factor.rest(open_[i].e));
    return b;
  }

  const LegsModel& model_;
  LegRange legs_;
  PlatformTwist platform_;
  RestFactor rest_;
  std::array<OpenLeg, max_dof> open_;
};

// A step that closes the legs.
Step closing_step(Newton& newton, const ChartNumbers& chart, const LegsState& state) {
  newton.factor(chart, state,
                [&newton](const ModelLeg& leg, const ChainPlace& place, const ChartNumbers&,
                          ClosureVector& e) { leg.residual(place, newton.platform(), e); });
  return newton.step();
}

// Newton's method. False unless it converges as fast as it does near a solution, on the side of singularities
// on which the robot is at home.
bool settle(Newton& newton, LegRange legs, const ChartNumbers& chart, int& budget, LegsState& state) {
  double before = std::numeric_limits<double>::infinity();
  for (int i = 0; i < max_steps && budget > 0; ++i, --budget) {
    const Step step = closing_step(newton, chart, state);
    if (!newton.keeps_signs()) return false;
    const double size = step.size(legs);
    if (!(size < longest_step) || (size > slowest * before && size > rounding)) return false;
    advance(legs, 1.0, step, state);
    if (size < last_step) return newton.rest(step) < largest_rest;
    before = size;
  }
  return false;
}

// The path chart(part) = home + part (target - home).
bool follow(const LegsModel& model, LegRange legs, const ChartNumbers& target, LegsState& state) {
  const ChartNumbers home = model.home_chart();
  const ChartNumbers way = target - home;
  for (std::size_t i = legs.first; i < legs.end; ++i) state.s[i] = model.legs[i].home;
  state.z = model.home_following;
  Newton newton(model, legs);
  const auto tangent = [&](double part) {
    newton.factor(home + part * way, state,
                  [&](const ModelLeg& leg, const ChainPlace&, const ChartNumbers& chart, ClosureVector& e) {
                    ChartNumbers free_way = way;
                    for (int i = 0; i < 6; ++i) {
                      const ChartRole role = model.moves.roles[static_cast<std::size_t>(i)];
                      if (role == ChartRole::follows) free_way[i] = 0.0;
                    }
                    ClosureMap P;
                    leg.platform_map(newton.platform(), Columns(chart_map(chart) * free_way), P);
                    e = P.col(0);
                  });
    return newton.step();
  };
  int budget = max_steps_of_path;
  double part = 0.0;
  double length = 1.0;
  Step along = tangent(part);
  while (part < 1.0) {
    if (length < shortest_part || budget <= 0) return false;
    const double next = std::min(1.0, part + length);
    LegsState trial = state;
    advance(legs, next - part, along, trial);
    if (settle(newton, legs, home + next * way, budget, trial)) {
      state = trial;
      part = next;
      length *= 2.0;
      if (part < 1.0) along = tangent(part);
    } else {
      length *= 0.5;
    }
  }
  return true;
}

bool assemble_leg(const LegsModel& model, std::size_t index, int mode, const PlatformTwist& platform,
                  const Configuration& pose, LegsState& state) {
  const ModelLeg& leg = model.legs[index];
  if (!leg.form) return follow(model, {index, index + 1}, model.chart(pose, state.z), state);
  Assembly assembly = leg.assembly;
  if (mode == 1) assembly.bend = -assembly.bend;
  const Eigen::Vector3d target = platform.origin + platform.axes * leg.closures.front().on_at;
  return leg.form->solve(leg.chain, target, assembly, state.s[index]);
}

}  // namespace

bool approach(const LegsModel& model, LegRange legs, const ChartNumbers& chart, LegsState& state) noexcept {
  Newton newton(model, legs);
  for (int i = 0; i < max_steps_of_path; ++i) {
    const Step step = closing_step(newton, chart, state);
    const double size = step.size(legs);
    if (!std::isfinite(size)) return false;
    advance(legs, std::min(1.0, longest_step_of_approach / size), step, state);
    if (size < last_step) return newton.rest(step) < largest_rest;
  }
  return false;
}

bool is_working_mode(const LegsModel& model, std::size_t index, int mode) noexcept {
  const auto& form = model.legs[index].form;
  return mode == 0 || (mode == 1 && form && form->is_arm());
}

bool assemble(const LegsModel& model, const Configuration& pose, const WorkingMode& mode,
              PlatformTwist& platform, LegsState& state) noexcept {
  const std::size_t count = model.legs.size();
  state.z = model.home_following;
  if (model.following() > 0) {
    if (!follow(model, {0, count}, model.chart(pose, state.z), state)) return false;
    model.place(pose, state.z, platform);
  } else {
    model.place(pose, state.z, platform);
    for (std::size_t i = 0; i < count; ++i) {
      if (!assemble_leg(model, i, mode[static_cast<int>(i)], platform, pose, state)) return false;
    }
  }
  for (std::size_t i = 0; i < count; ++i) {
    if (!is_within_range(model.legs[i].chain, state.s[i])) return false;
  }
  return true;
}

}  // namespace flinch
