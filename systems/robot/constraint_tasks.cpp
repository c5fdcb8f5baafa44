#include "systems/robot/constraint_tasks.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

#include "systems/robot/decompositions.h"
#include "systems/robot/link_segments.h"

namespace flinch {
namespace {

constexpr double distance_of_differences = 2e-4;  // [m or rad]
constexpr double same_singular_value = 1e-9;      // relative
constexpr double same_distance = 1e-9;            // [m]
constexpr double crossing = 1e-9;                 // [m]

using Eigensystem = Eigen::SelfAdjointEigenSolver<PlatformMatrix>;

// J_qa,x with angles counted at the characteristic length.
PlatformMatrix scaled(const Mechanism& mechanism, const PlatformMatrix& J) {
  PlatformMatrix scaled = J;
  scaled.rightCols(mechanism.space().rotations()) /= mechanism.description().characteristic_length;
  return scaled;
}

double second_difference(double before, double now, double after, double step) {
  return (before - 2.0 * now + after) / (step * step);
}

/// The eigenvalues of J_qa,x^T J_qa,x, ascending, and their gradients in the platform's coordinates.
struct Spectrum {
  PlatformVector lambda;
  PlatformMatrix gradients;  ///< one row an eigenvalue
};

// d lambda = 2 (J w)^T (dJ w) for an eigenvector w; dJ along a coordinate is the rate of J at its unit
// velocity.
Spectrum spectrum_of(const Mechanism& mechanism, const Kinematics& kinematics) {
  const int n = mechanism.dof();
  const PlatformMatrix J = scaled(mechanism, kinematics.J_qa_x);
  const Eigensystem system(J.transpose() * J);
  const PlatformMatrix& w = system.eigenvectors();
  const PlatformMatrix J_w = J * w;
  Spectrum spectrum{system.eigenvalues(), PlatformMatrix::Zero(n, n)};
  Kinematics moving;
  for (int axis = 0; axis < n; ++axis) {
    mechanism.kinematics(kinematics.pose, PlatformVector::Unit(n, axis), moving);
    const PlatformMatrix dJ_w = scaled(mechanism, moving.dJ_qa_x) * w;
    for (int i = 0; i < n; ++i) spectrum.gradients(i, axis) = 2.0 * J_w.col(i).dot(dJ_w.col(i));
  }
  return spectrum;
}

// Mean gradient of ln lambda over the eigenvalues that equal `lambda`.
Eigen::Matrix<double, 1, Eigen::Dynamic, Eigen::RowMajor, 1, max_dof> log_gradient(const Spectrum& spectrum,
                                                                                   double lambda) {
  Eigen::Matrix<double, 1, Eigen::Dynamic, Eigen::RowMajor, 1, max_dof> sum;
  sum.setZero(spectrum.gradients.cols());
  int equal = 0;
  for (int i = 0; i < spectrum.lambda.size(); ++i) {
    if (std::abs(spectrum.lambda[i] - lambda) > same_singular_value * lambda) continue;
    sum += spectrum.gradients.row(i);
    ++equal;
  }
  return sum / (equal * lambda);
}

double log_smooth_condition_number(const PlatformVector& lambda, int p) {
  const auto n = lambda.size();
  const double largest = lambda[n - 1];
  double sum = n > 1 ? 0.0 : 1.0;
  for (Eigen::Index i = 1; i < n; ++i) sum += std::pow(lambda[i] / largest, p);
  return 0.5 * (std::log(largest / lambda[0]) + std::log(sum) / p);
}

double log_smooth_condition_number(const Mechanism& mechanism, const PlaceKinematics& place, int p) {
  const PlatformMatrix J = scaled(mechanism, place.J_qa_x);
  return log_smooth_condition_number(Eigensystem(J.transpose() * J, Eigen::EigenvaluesOnly).eigenvalues(), p);
}

// ---------------------------------------------------------------- self-collision

double distance_of(const PlaceKinematics& place, const BodyPair& pair) {
  return segment_distance(link_segment(place.legs, BodyId::from_index(pair.a)),
                          link_segment(place.legs, BodyId::from_index(pair.b)))
      .distance;
}

struct Nearest {
  CartesianVector point;
  CartesianJacobian J;
};

// Of a link's own axis, which ends with `axis` but begins elsewhere where the link slides in the one before.
double own_fraction(const Mechanism& mechanism, BodyId link, const Segment& axis, double fraction) {
  const double own = (mechanism.axis_point(link, 1.0) - mechanism.axis_point(link, 0.0)).norm();
  const double length = (axis.end - axis.begin).norm();
  const bool same = !(own > 0.0) || std::abs(length - own) < 1e-9 * own;
  return same ? fraction : 1.0 - (1.0 - fraction) * length / own;
}

Nearest nearest_of(const Mechanism& mechanism, const Kinematics& kinematics, int index, double fraction) {
  const BodyId body = BodyId::from_index(index);
  const Segment axis = link_segment(kinematics, body);
  Nearest nearest;
  nearest.point = axis.begin + fraction * (axis.end - axis.begin);
  const double own = own_fraction(mechanism, body, axis, fraction);
  nearest.J = mechanism.contact_jacobian(kinematics, body, mechanism.axis_point(body, own)).translation;
  return nearest;
}

// Where the fractions move they do so along the axes, across which the links are nearest: the points count as
// fixed to their bodies.
PlatformVector gradient_of(const Mechanism& mechanism, const Kinematics& kinematics,
                           const NearestLinks& links) {
  PlatformVector gradient = PlatformVector::Zero(mechanism.dof());
  const double distance = links.segments.distance;
  if (!(distance > crossing)) return gradient;
  const Nearest a = nearest_of(mechanism, kinematics, links.bodies.a, links.segments.fraction_a);
  const Nearest b = nearest_of(mechanism, kinematics, links.bodies.b, links.segments.fraction_b);
  const CartesianVector direction = (a.point - b.point) / distance;
  gradient = (a.J - b.J).transpose() * direction;
  return gradient;
}

/// Shortest vector between those of `count`, by Gilbert's algorithm: move towards the one that leans back
/// most, until none does.
PlatformVector shortest_between(const std::array<PlatformVector, max_nearest_links>& vectors, int count) {
  constexpr int most_steps = 30;
  PlatformVector shortest = vectors[0];
  for (int step = 0; step < most_steps; ++step) {
    const auto leaning = std::min_element(
        vectors.begin(), vectors.begin() + count,
        [&](const PlatformVector& a, const PlatformVector& b) { return a.dot(shortest) < b.dot(shortest); });
    const PlatformVector way = *leaning - shortest;
    const double squared = way.squaredNorm();
    if (!(-way.dot(shortest) > 1e-15 * shortest.squaredNorm()) || !(squared > 0.0)) break;
    shortest += std::min(1.0, -way.dot(shortest) / squared) * way;
  }
  return shortest;
}

}  // namespace

void evaluate_nearby(const Mechanism& mechanism, const Kinematics& kinematics, NearbyPlaces& out) noexcept {
  const double speed = kinematics.velocity.norm();
  out.step = 0.0;
  if (!kinematics.reachable || !(speed > 0.0)) return;
  const PlatformVector moved = distance_of_differences / speed * kinematics.velocity;
  const ConfigurationSpace space = mechanism.space();
  mechanism.place(space.plus(kinematics.pose, moved), out.after);
  mechanism.place(space.plus(kinematics.pose, -moved), out.before);
  if (out.before.valid && out.after.valid) out.step = distance_of_differences / speed;
}

Task condition_number_task(const Mechanism& mechanism, const Kinematics& kinematics,
                           const NearbyPlaces& nearby) noexcept {
  Task task = no_task(1, mechanism.dof());
  if (!kinematics.valid) return task;
  const Spectrum spectrum = spectrum_of(mechanism, kinematics);
  const double kappa = kinematics.sigma_kappa;
  const double smallest = spectrum.lambda[0];
  const double largest = spectrum.lambda[spectrum.lambda.size() - 1];
  if (!(smallest > std::numeric_limits<double>::epsilon() * largest)) return task;
  task.sigma[0] = kappa;
  task.J = 0.5 * kappa * (log_gradient(spectrum, largest) - log_gradient(spectrum, smallest));
  if (nearby.step > 0.0) {
    task.drift[0] =
        second_difference(nearby.before.sigma_kappa, kappa, nearby.after.sigma_kappa, nearby.step);
  }
  task.valid = task.J.allFinite();
  return task;
}

Task smooth_condition_number_task(const Mechanism& mechanism, const Kinematics& kinematics,
                                  const NearbyPlaces& nearby, int p) noexcept {
  Task task = no_task(1, mechanism.dof());
  if (!kinematics.valid) return task;
  const Spectrum spectrum = spectrum_of(mechanism, kinematics);
  const PlatformVector& lambda = spectrum.lambda;
  const auto n = lambda.size();
  if (!(lambda[0] > std::numeric_limits<double>::epsilon() * lambda[n - 1])) return task;
  task.sigma[0] = log_smooth_condition_number(lambda, p);
  double sum = 0.0;  // of (lambda_i / largest)^p
  for (Eigen::Index i = 1; i < n; ++i) {
    const double share = std::pow(lambda[i] / lambda[n - 1], p);
    sum += share;
    task.J += 0.5 * share / lambda[i] * spectrum.gradients.row(i);
  }
  if (sum > 0.0) task.J /= sum;
  task.J -= 0.5 / lambda[0] * spectrum.gradients.row(0);
  if (nearby.step > 0.0) {
    task.drift[0] = second_difference(log_smooth_condition_number(mechanism, nearby.before, p), task.sigma[0],
                                      log_smooth_condition_number(mechanism, nearby.after, p), nearby.step);
  }
  task.valid = task.J.allFinite();
  return task;
}

// The drift is that of one pair of links: the distance of a pair has no kinks.
Task self_collision_task(const Mechanism& mechanism, const Kinematics& kinematics,
                         const NearbyPlaces& nearby) noexcept {
  Task task = no_task(1, mechanism.dof());
  const NearestLinksList nearest = nearest_links(mechanism, kinematics, same_distance);
  if (nearest.count == 0) return task;
  std::array<PlatformVector, max_nearest_links> gradients;
  const NearestLinks* first = nearest.links.data();
  for (int i = 0; i < nearest.count; ++i) {
    const auto index = static_cast<std::size_t>(i);
    gradients[index] = gradient_of(mechanism, kinematics, nearest.links[index]);
    if (nearest.links[index].segments.distance < first->segments.distance) first = &nearest.links[index];
  }
  task.sigma[0] = first->segments.distance;
  task.J = shortest_between(gradients, nearest.count).transpose();
  if (nearby.step > 0.0) {
    task.drift[0] = second_difference(distance_of(nearby.before, first->bodies), task.sigma[0],
                                      distance_of(nearby.after, first->bodies), nearby.step);
  }
  task.valid = task.J.allFinite();
  return task;
}

}  // namespace flinch
