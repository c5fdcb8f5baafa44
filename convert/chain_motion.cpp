#include "convert/chain_motion.h"

#include <Eigen/Geometry>
#include <algorithm>

#include "systems/robot/decompositions.h"
#include "systems/robot/legs/platform_twist.h"

namespace flinch {
namespace {

constexpr int most_steps = 100;
constexpr double longest_step = 0.2;     // of an angle [rad] or length [m]
constexpr double least_singular = 1e-7;  // of the largest: smaller is a motion that nothing holds

Eigen::Isometry3d motion_of(const ChainLink& link, double q) {
  Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
  if (link.slides()) {
    motion.translation() = q * link.axis;
  } else {
    motion.linear() = Eigen::AngleAxisd(q, link.axis).toRotationMatrix();
    motion.translation() = q * link.lead * link.axis;
  }
  return motion;
}

double position(const ChainLink& link, const Eigen::VectorXd& s) {
  return link.ratio * s[link.coordinate] + link.offset;
}

struct Rows {
  Eigen::Vector3d linear = Eigen::Vector3d::Zero(), angular = Eigen::Vector3d::Zero();
};

class RowWriter {
 public:
  RowWriter(const ClosedChains& chains, const ChainState& state) : chains_(chains), state_(state) {}

  ClosureRows write() {
    int rows = 0;
    int columns = 0;
    for (const ChainLeg& leg : chains_.legs) {
      out_.first_row.push_back(rows);
      out_.first_column.push_back(columns);
      for (const ChainJoin& join : leg.joins) rows += rows_of(join);
      columns += leg.coordinates;
    }
    out_.first_row.push_back(rows);
    out_.first_column.push_back(columns);
    out_.e.setZero(rows);
    out_.J.setZero(rows, columns + (chains_.planar ? 3 : 6));
    for (std::size_t i = 0; i < chains_.legs.size(); ++i) write_leg(i);
    return std::move(out_);
  }

 private:
  int rows_of(const ChainJoin& join) const {
    return (chains_.planar ? 2 : 3) + (!join.holds_frame ? 0 : chains_.planar ? 1 : 3);
  }

  void write_leg(std::size_t i) {
    const ChainLeg& leg = chains_.legs[i];
    const std::vector<Eigen::Isometry3d> places = link_places(leg, state_.s[i]);
    int row = out_.first_row[i];
    for (const ChainJoin& join : leg.joins) {
      const Eigen::Isometry3d a = places[join.link] * join.at;
      Eigen::Isometry3d b = join.on_at;
      if (join.on == ChainJoin::On::platform) b = state_.platform * join.on_at;
      if (join.on == ChainJoin::On::link) b = places[join.on_link] * join.on_at;
      Rows gap;
      gap.linear = b.translation() - a.translation();
      gap.angular = rotation_log(b.linear() * a.linear().transpose());
      for (int k = 0; k < rows_of(join); ++k) out_.e[row + k] = entry(gap, k, join);
      add_columns(i, places, join.link, a.translation(), -1.0, row, join);
      if (join.on == ChainJoin::On::link)
        add_columns(i, places, join.on_link, b.translation(), 1.0, row, join);
      if (join.on == ChainJoin::On::platform)
        add_platform(b.translation() - state_.platform.translation(), row, join);
      row += rows_of(join);
    }
  }

  double entry(const Rows& of, int k, const ChainJoin&) const {
    const int directions = chains_.planar ? 2 : 3;
    if (k < directions) return of.linear[k];
    return chains_.planar ? of.angular.z() : of.angular[k - directions];
  }

  void add(const Rows& of, double sign, int row, int column, const ChainJoin& join) {
    for (int k = 0; k < rows_of(join); ++k) out_.J(row + k, column) += sign * entry(of, k, join);
  }

  // How a point moves with the joints from the base to its link.
  void add_columns(std::size_t i, const std::vector<Eigen::Isometry3d>& places, std::size_t of,
                   const Eigen::Vector3d& point, double sign, int row, const ChainJoin& join) {
    const ChainLeg& leg = chains_.legs[i];
    for (int l = static_cast<int>(of); l >= 0; l = leg.links[static_cast<std::size_t>(l)].parent) {
      const ChainLink& link = leg.links[static_cast<std::size_t>(l)];
      const Eigen::Isometry3d& place = places[static_cast<std::size_t>(l)];
      const Eigen::Vector3d axis = place.linear() * link.axis;
      Rows rate;
      rate.linear = axis;
      if (!link.slides()) {
        rate.linear = axis.cross(point - place.translation()) + link.lead * axis;
        rate.angular = axis;
      }
      add(rate, sign * link.ratio, row, out_.first_column[i] + link.coordinate, join);
    }
  }

  void add_platform(const Eigen::Vector3d& arm, int row, const ChainJoin& join) {
    int column = out_.first_column.back();
    for (int k = 0; k < 6; ++k) {
      if (chains_.planar && k != 0 && k != 1 && k != 5) continue;
      Rows rate;
      const Eigen::Vector3d unit = Eigen::Vector3d::Unit(k % 3);
      rate.linear = k < 3 ? unit : Eigen::Vector3d(unit.cross(arm));
      if (k >= 3) rate.angular = unit;
      add(rate, 1.0, row, column++, join);
    }
  }

  const ClosedChains& chains_;
  const ChainState& state_;
  ClosureRows out_;
};

}  // namespace

ChainState resting_state(const ClosedChains& chains) {
  ChainState state;
  for (const ChainLeg& leg : chains.legs) state.s.emplace_back(Eigen::VectorXd::Zero(leg.coordinates));
  state.platform = chains.platform;
  if (chains.planar) state.platform.translation().z() = 0.0;
  return state;
}

std::vector<Eigen::Isometry3d> link_places(const ChainLeg& leg, const Eigen::VectorXd& s) {
  std::vector<Eigen::Isometry3d> places;
  for (const ChainLink& link : leg.links) {
    Eigen::Isometry3d place = Eigen::Isometry3d::Identity();
    Eigen::Vector3d at = link.origin;
    if (link.parent >= 0) {
      place = places[static_cast<std::size_t>(link.parent)];
      at -= leg.links[static_cast<std::size_t>(link.parent)].origin;
    }
    places.push_back(place * Eigen::Translation3d(at) * motion_of(link, position(link, s)));
  }
  return places;
}

ClosureRows closure_rows(const ClosedChains& chains, const ChainState& state) {
  return RowWriter(chains, state).write();
}

void move(const ClosedChains& chains, const Eigen::VectorXd& step, ChainState& state) {
  Eigen::Index next = 0;
  for (Eigen::VectorXd& s : state.s) {
    s += step.segment(next, s.size());
    next += s.size();
  }
  if (chains.planar) {
    state.platform.translation().head<2>() += step.segment<2>(next);
    state.platform.linear() =
        rotation_exp(step[next + 2] * Eigen::Vector3d::UnitZ()) * state.platform.linear();
  } else {
    state.platform.translation() += step.segment<3>(next);
    state.platform.linear() = rotation_exp(step.segment<3>(next + 3)) * state.platform.linear();
  }
}

std::optional<ChainState> closed(const ClosedChains& chains, ChainState state, double tolerance) {
  double last = std::numeric_limits<double>::infinity();
  for (int i = 0; i < most_steps; ++i) {
    const ClosureRows rows = closure_rows(chains, state);
    const double gap = rows.e.size() == 0 ? 0.0 : rows.e.lpNorm<Eigen::Infinity>();
    if (!std::isfinite(gap)) return std::nullopt;
    // To rounding, as far as it goes.
    if (gap < 1e-15 || (gap < tolerance && gap >= 0.5 * last)) return state;
    last = gap;
    Eigen::JacobiSVD<Eigen::MatrixXd> svd(rows.J, Eigen::ComputeThinU | Eigen::ComputeThinV);
    svd.setThreshold(least_singular);
    Eigen::VectorXd step = -svd.solve(rows.e);
    const double length = step.lpNorm<Eigen::Infinity>();
    if (length > longest_step) step *= longest_step / length;
    move(chains, step, state);
  }
  return std::nullopt;
}

Eigen::MatrixXd free_motions(const ClosedChains& chains, const ChainState& state, double length) {
  ClosureRows rows = closure_rows(chains, state);
  const Eigen::Index angles = chains.planar ? 1 : 3;
  rows.J.rightCols(angles) /= length;
  const Eigen::Index columns = rows.J.cols();
  if (rows.J.rows() == 0) return Eigen::MatrixXd::Identity(columns, columns);
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(rows.J, Eigen::ComputeFullV);
  const Eigen::VectorXd& values = svd.singularValues();
  const Eigen::Index rank = (values.array() > least_singular * std::max(values[0], 1e-12)).count();
  return svd.matrixV().rightCols(columns - rank);
}

}  // namespace flinch
