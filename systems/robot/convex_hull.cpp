#include "systems/robot/convex_hull.h"

#include <Eigen/Core>
#include <algorithm>

#include "systems/robot/decompositions.h"

namespace flinch {

double thickness(const ConvexHull& hull) {
  if (hull.points.empty()) return 0.0;
  Eigen::Matrix3Xd points(3, static_cast<Eigen::Index>(hull.points.size()));
  for (Eigen::Index i = 0; i < points.cols(); ++i) points.col(i) = hull.points[static_cast<std::size_t>(i)];
  points.colwise() -= Eigen::Vector3d(points.rowwise().mean());
  const Eigen::Matrix3d moments = points * points.transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> scatter(moments);
  const Eigen::RowVectorXd along = scatter.eigenvectors().col(0).transpose() * points;
  return along.maxCoeff() - along.minCoeff();
}

std::string complaint_about_points(const ConvexHull& hull) {
  const std::string count = "has " + std::to_string(hull.points.size()) + " entries; ";
  if (hull.points.size() < 4) return count + "a hull needs at least 4";
  if (hull.points.size() > most_hull_points) {
    return count + "a hull may have at most " + std::to_string(most_hull_points) + ", its corners are enough";
  }
  const auto is_finite = [](const Eigen::Vector3d& point) { return point.allFinite(); };
  if (!std::all_of(hull.points.begin(), hull.points.end(), is_finite)) return "must be finite";
  if (!(thickness(hull) >= least_hull_thickness))
    return "lie in a plane; the hull must be at least 0.1 mm thick";
  return "";
}

}  // namespace flinch
