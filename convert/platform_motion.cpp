#include "convert/platform_motion.h"

#include <algorithm>
#include <random>

#include "systems/foundation/nearest_name.h"
#include "systems/robot/decompositions.h"

namespace flinch {
namespace {

constexpr double still = 1e-7;      // rates below it, of a motion of size 1, are none
constexpr double same_line = 1e-6;  // of directions
constexpr double least_spanned =
    0.02;  // least of the largest singular value of coordinates that span motions

Eigen::Index platform_column(const ClosedChains& chains) { return chains.coordinates(); }

/// Rows of the twist of the platform: 3 or 6.
Eigen::MatrixXd platform_rows(const ClosedChains& chains, const Eigen::MatrixXd& motions) {
  return motions.bottomRows(motions.rows() - platform_column(chains));
}

Eigen::Index rank_of(const Eigen::MatrixXd& matrix) {
  if (matrix.size() == 0) return 0;
  const Eigen::VectorXd values = Eigen::JacobiSVD<Eigen::MatrixXd>(matrix).singularValues();
  return (values.array() > still).count();
}

double least_over_largest(const Eigen::MatrixXd& matrix) {
  if (matrix.size() == 0) return 1.0;
  const Eigen::VectorXd values = Eigen::JacobiSVD<Eigen::MatrixXd>(matrix).singularValues();
  return values[0] > 0.0 ? values[values.size() - 1] / values[0] : 0.0;
}

/// Calls `visit(link, row)` for each link that is moved by a coordinate of its own.
template <class Visit>
void for_each_free_link(const ClosedChains& chains, Visit visit) {
  Eigen::Index first = 0;
  for (const ChainLeg& leg : chains.legs) {
    for (const ChainLink& link : leg.links) {
      if (link.follows < 0) visit(link, first + link.coordinate);
    }
    first += leg.coordinates;
  }
}

/// Names of joints that move while the platform does not.
std::vector<std::string> idle_joints(const ClosedChains& chains, const Eigen::MatrixXd& motions) {
  const Eigen::MatrixXd platform = platform_rows(chains, motions);
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(platform, Eigen::ComputeFullV);
  const Eigen::Index rank = (svd.singularValues().array() > still).count();
  const Eigen::MatrixXd idle = motions * svd.matrixV().rightCols(motions.cols() - rank);
  std::vector<std::string> names;
  for_each_free_link(chains, [&](const ChainLink& link, Eigen::Index row) {
    if (idle.row(row).norm() > 1e-3) names.push_back("'" + link.name + "'");
  });
  if (names.size() > 6) names.resize(6);
  return names;
}

std::string moved_names(const Eigen::MatrixXd& platform) {
  std::vector<std::string> names;
  for (Eigen::Index i = 0; i < 6; ++i) {
    if (platform.row(i).norm() > still) names.emplace_back(chart_names[static_cast<std::size_t>(i)]);
  }
  return listed(names);
}

/// Whether each platform coordinate moves in any of the samples: x, y, z, rx, ry, rz.
std::array<bool, 6> moving(const ClosedChains& chains, const MotionSamples& samples) {
  std::array<bool, 6> moves{};
  for (const Eigen::MatrixXd& motions : samples.motions) {
    const Eigen::MatrixXd platform = platform_rows(chains, motions);
    for (Eigen::Index i = 0; i < platform.rows(); ++i) {
      const auto chart = static_cast<std::size_t>(chains.planar && i == 2 ? 5 : i);
      moves[chart] = moves[chart] || platform.row(i).norm() > still;
    }
  }
  return moves;
}

bool translations_span(const ClosedChains& chains, const MotionSamples& samples) {
  const Eigen::Index directions = chains.planar ? 2 : 3;
  const Eigen::MatrixXd& at_home = samples.motions.front();
  return least_over_largest(platform_rows(chains, at_home).topRows(directions)) > least_spanned;
}

std::string counted_coordinates(Eigen::Index count) {
  return std::to_string(count) + (count == 1 ? " coordinate" : " coordinates");
}

}  // namespace

MotionSamples motion_samples(const ClosedChains& chains, const ChainState& home, double length, int count,
                             double tolerance) {
  MotionSamples samples{{home}, {free_motions(chains, home, length)}};
  std::mt19937 generator(1);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const Eigen::Index angles = chains.planar ? 1 : 3;
  for (int i = 0; i < count; ++i) {
    const Eigen::MatrixXd& motions = samples.motions.front();
    Eigen::VectorXd weights(motions.cols());
    for (double& weight : weights) weight = uniform(generator);
    Eigen::VectorXd step = 0.1 * motions * weights;
    step.tail(angles) /= length;
    ChainState state = home;
    move(chains, step, state);
    const auto found = closed(chains, state, tolerance);
    if (!found) continue;
    samples.motions.push_back(free_motions(chains, *found, length));
    samples.states.push_back(*found);
  }
  return samples;
}

std::vector<std::size_t> frozen_joints(const ClosedChains& chains, const MotionSamples& samples) {
  std::vector<std::size_t> frozen;
  for_each_free_link(chains, [&](const ChainLink& link, Eigen::Index row) {
    const bool stays =
        std::all_of(samples.motions.begin(), samples.motions.end(),
                    [&](const Eigen::MatrixXd& motions) { return motions.row(row).norm() < 1e-6; });
    if (stays) frozen.push_back(link.joint);
  });
  return frozen;
}

std::optional<Eigen::Vector3d> plane_normal(const ClosedChains& chains, const ChainState& state) {
  std::vector<Eigen::Vector3d> turning, sliding;
  for (std::size_t i = 0; i < chains.legs.size(); ++i) {
    const std::vector<Eigen::Isometry3d> places = link_places(chains.legs[i], state.s[i]);
    for (std::size_t l = 0; l < places.size(); ++l) {
      const ChainLink& link = chains.legs[i].links[l];
      if (link.kind == GraphJoint::Kind::screw) return std::nullopt;
      (link.slides() ? sliding : turning).push_back(places[l].linear() * link.axis);
    }
  }
  if (turning.empty()) return std::nullopt;
  const Eigen::Vector3d& normal = turning.front();
  for (const Eigen::Vector3d& axis : turning) {
    if (normal.cross(axis).norm() > same_line) return std::nullopt;
  }
  for (const Eigen::Vector3d& axis : sliding) {
    if (std::abs(normal.dot(axis)) > same_line) return std::nullopt;
  }
  return normal;
}

PlatformMoves platform_moves(const BodyGraph& graph, const ClosedChains& chains,
                             const MotionSamples& samples) {
  const Eigen::MatrixXd& at_home = samples.motions.front();
  const Eigen::MatrixXd platform = platform_rows(chains, at_home);
  const Eigen::Index n = rank_of(platform);
  if (n == 0) graph.refuse("the closures leave the platform no motion: check their frames, and --platform");
  if (at_home.cols() > n) {
    graph.refuse("joints " + listed(idle_joints(chains, at_home)) +
                 " can move while the platform stands still, so that its pose does not say where they are; "
                 "fix what need not turn, or close it on another link");
  }
  const std::array<bool, 6> moves = moving(chains, samples);
  std::array<ChartRole, 6> roles{};
  for (std::size_t i = 0; i < 6; ++i) roles[i] = moves[i] ? ChartRole::follows : ChartRole::fixed;
  if (chains.planar && n == 3) return moves_of("planar_pose");
  if (!chains.planar && n == 6) return moves_of("spatial_pose");
  const Eigen::Index directions = chains.planar ? 2 : 3;
  if (n == directions && translations_span(chains, samples)) {
    for (Eigen::Index i = 0; i < n; ++i) roles[static_cast<std::size_t>(i)] = ChartRole::free;
    if (chains.planar && roles[5] == ChartRole::fixed) return moves_of("plane");
    if (const auto found = moves_of(roles)) return *found;
  }
  const std::string where = chains.planar ? " in a plane" : " in space, by " + moved_names(platform);
  graph.refuse(
      "the platform, '" + graph.bodies[chains.platform_body].name + "', moves in " + counted_coordinates(n) +
      where +
      "; robots of flinch move in x and y of a plane, or turn there too, in x, y and z, or in all six");
}

double distance_from_singularities(const BodyGraph& graph, const ClosedChains& chains,
                                   const ChainState& state, double length) {
  const ClosureRows rows = closure_rows(chains, state);
  double least = 1.0;
  for (std::size_t i = 0; i < chains.legs.size(); ++i) {
    const int first = rows.first_row[i];
    const int column = rows.first_column[i];
    Eigen::MatrixXd J =
        rows.J.block(first, column, rows.first_row[i + 1] - first, chains.legs[i].coordinates);
    int row = 0;
    for (const ChainJoin& join : chains.legs[i].joins) {  // lengths by `length`
      const int linear = chains.planar ? 2 : 3;
      J.middleRows(row, linear) /= length;
      row += linear + (!join.holds_frame ? 0 : chains.planar ? 1 : 3);
    }
    for (const ChainLink& link : chains.legs[i].links) {
      if (link.slides() && link.follows < 0) J.col(link.coordinate) *= length;
    }
    if (J.rows() < J.cols()) return 0.0;
    least = std::min(least, least_over_largest(J));
  }
  const Eigen::MatrixXd motions = free_motions(chains, state, length);
  if (motions.cols() == 0) return 0.0;
  std::vector<Eigen::Index> driven;
  for_each_free_link(chains, [&](const ChainLink& link, Eigen::Index row) {
    if (graph.joints[link.joint].driven) driven.push_back(row);
  });
  Eigen::MatrixXd drives(static_cast<Eigen::Index>(driven.size()), motions.cols());
  for (std::size_t i = 0; i < driven.size(); ++i)
    drives.row(static_cast<Eigen::Index>(i)) = motions.row(driven[i]);
  if (drives.rows() < drives.cols()) return least;  // told elsewhere
  return std::min({least, least_over_largest(drives), least_over_largest(platform_rows(chains, motions))});
}

}  // namespace flinch
