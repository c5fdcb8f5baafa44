#include "systems/contact/touch_hypotheses.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "systems/foundation/findings.h"
#include "systems/foundation/setup_error.h"
#include "systems/robot/outline.h"

namespace flinch {
namespace {

constexpr double impossible = -1e6;
constexpr double negligible = 30.0;   // ln of how much smaller what adds nothing to a sum is
constexpr double surely_free = 37.0;  // softnesses away: what is there leaves a room of 1 to the last bit

Eigen::Vector3d in_space(const CartesianVector& v) {
  Eigen::Vector3d spatial = Eigen::Vector3d::Zero();
  spatial.head(v.size()) = v;
  return spatial;
}

/// Rows of a map of angular velocity: in the plane about z.
Eigen::Matrix<double, 3, Eigen::Dynamic, 0, 3, max_dof> about_axes(const CartesianJacobian& rotation) {
  Eigen::Matrix<double, 3, Eigen::Dynamic, 0, 3, max_dof> spatial(3, rotation.cols());
  spatial.setZero();
  spatial.bottomRows(rotation.rows()) = rotation;
  return spatial;
}

double normal_density(double x) { return std::exp(-0.5 * x * x) / std::sqrt(2.0 * std::numbers::pi); }
double normal_share(double x) { return 0.5 * std::erfc(-x * std::numbers::sqrt2 / 2.0); }

/// E[max(v - w, 0)] for w ~ N(0, sigma^2) [m/s].
double approach_weight(double v, double sigma) {
  return sigma * normal_density(v / sigma) + v * normal_share(v / sigma);
}

/// ln of the likelihood of a whitened wrench less that of no contact, for a force a >= 0 along h.
struct ForceFit {
  double log_gain = impossible;
  double force = 0.0;      // posterior mean, not below 0 [N]
  double explained = 0.0;  // of F^T S^-1 F
};

/// What `ForceFit::log_gain` cannot exceed.
double most_gain(double explained) { return 0.5 * explained + std::numbers::ln2; }

ForceFit fit_force(double hh, double hF, double scale) {
  const double precision = hh + 1.0 / (scale * scale);
  const double s = 1.0 / std::sqrt(precision);
  const double m = hF / precision;
  ForceFit fit;
  fit.force = std::max(m, 0.0);
  if (hF > 0.0 && hh > 0.0) fit.explained = hF * hF / hh;
  const double share = normal_share(m / s);
  if (share > 1e-12) fit.log_gain = 0.5 * m * m * precision + std::log(2.0 * s / scale * share);
  return fit;
}

/// `count` directions, evenly around the plane or over the sphere.
std::vector<Eigen::Vector3d> directions(int dimension, int count) {
  std::vector<Eigen::Vector3d> all;
  const double golden = std::numbers::pi * (3.0 - std::sqrt(5.0));
  for (int i = 0; i < count; ++i) {
    const double z = dimension == 2 ? 0.0 : 1.0 - 2.0 * (i + 0.5) / count;
    const double angle = dimension == 2 ? 2.0 * std::numbers::pi * i / count : golden * i;
    const double r = std::sqrt(1.0 - z * z);
    all.emplace_back(r * std::cos(angle), r * std::sin(angle), z);
  }
  return all;
}

}  // namespace

/// What is the same for all classes at one instant. L L^T = S whitens wrenches.
struct TouchHypotheses::Scene {
  const std::array<LegPoints, max_dof>* legs = nullptr;
  std::array<Placed, max_bodies> bodies;
  WhitenedWrench wrench;  // L^-1 F
};

/// What has been found of one class: a sum of likelihoods that are known by their logarithms.
struct TouchHypotheses::Tally {
  double top = impossible;  // the largest
  double sum = 0.0;         // of all, as multiples of it
  double explained = 0.0;
  double location = 0.0, force = 0.0, approach = 0.0;

  bool is_negligible(double logarithm) const { return logarithm < top - negligible; }
  void add(double weight, const ForceFit& fit, double fraction, double speed) {
    const double logarithm = std::log(weight) + fit.log_gain;
    if (!(logarithm > impossible) || is_negligible(logarithm)) return;
    if (logarithm <= top) {
      sum += std::exp(logarithm - top);
      return;
    }
    sum = sum * std::exp(top - logarithm) + 1.0;
    top = logarithm;
    location = fraction;
    force = fit.force;
    approach = speed;
  }
};

TouchHypotheses::TouchHypotheses(std::shared_ptr<const ParallelRobot> robot,
                                 const TouchHypothesesSettings& settings)
    : robot_(std::move(robot)),
      settings_(settings),
      classes_(robot_->body_count(), robot_->legs()),
      places_(static_cast<std::size_t>(robot_->body_count())) {
  Findings found("contact hypotheses: ");
  found.positive("force_scale", settings.force_scale, "N");
  found.positive("object_speed", settings.object_speed, "m/s");
  found.positive("object_radius", settings.object_radius, "m");
  found.positive("softness", settings.softness, "m");
  found.positive("closing_speed", settings.closing_speed, "m/s");
  found.not_negative("friction", settings.friction);
  found.require(settings.points_along > 0 && settings.points_around > 0, "there must be points to try");
  throw_if_any(found.take());
  for (int i = 0; i < robot_->body_count(); ++i) add_places(BodyId::from_index(i));
}

void TouchHypotheses::add_places(BodyId body) {
  std::vector<Place>& places = places_[static_cast<std::size_t>(body.index())];
  const int dimension = robot_->space_dimension();
  for (const Shape& shape : robot_->body(body).shapes) {
    if (const auto* capsule = std::get_if<Capsule>(&shape)) {
      const Eigen::Vector3d axis = (capsule->end - capsule->begin).normalized();
      const Eigen::Vector3d across =
          dimension == 2 ? Eigen::Vector3d::UnitZ().cross(axis) : axis.unitOrthogonal();
      for (int i = 0; i < settings_.points_along; ++i) {
        const double fraction = (i + 0.5) / settings_.points_along;
        const Eigen::Vector3d point = capsule->begin + fraction * (capsule->end - capsule->begin);
        for (const Eigen::Vector3d& turned : directions(2, dimension == 2 ? 2 : 8)) {
          const Eigen::Vector3d normal = turned.x() * across + turned.y() * axis.cross(across);
          places.push_back({point + capsule->radius * normal, normal, fraction});
        }
      }
    } else {
      const Outline outline({shape});
      for (const Eigen::Vector3d& direction : directions(dimension, settings_.points_around)) {
        const LinePassage passage = outline.passage(Eigen::Vector3d::Zero(), direction);
        if (!passage.hits) continue;
        const Eigen::Vector3d point = passage.leave * direction;
        places.push_back({point, outline.normal_at(point), 0.0});
      }
    }
  }
}

double TouchHypotheses::room(const Scene& scene, int body, int other, const Eigen::Vector3d& centre) const {
  double room = 1.0;
  for (int i = 0; i < robot_->body_count(); ++i) {
    const Placed& placed = scene.bodies[static_cast<std::size_t>(i)];
    if (i == body || i == other || placed.radius < 0.0) continue;
    const Eigen::Vector3d axis = placed.end - placed.begin;
    const double length = axis.squaredNorm();
    const double fraction =
        length > 0.0 ? std::clamp((centre - placed.begin).dot(axis) / length, 0.0, 1.0) : 0.0;
    const double gap =
        (centre - placed.begin - fraction * axis).norm() - placed.radius - settings_.object_radius;
    if (gap > surely_free * settings_.softness) continue;
    room *= 1.0 / (1.0 + std::exp(-gap / settings_.softness));
  }
  return room;
}

void TouchHypotheses::weigh_body(const Scene& scene, BodyId body, Tally& tally) const {
  const auto at = static_cast<std::size_t>(body.index());
  const Placed& placed = scene.bodies[at];
  const double each = 1.0 / static_cast<double>(std::max<std::size_t>(places_[at].size(), 1));
  for (const Place& place : places_[at]) {
    const Eigen::Vector3d arm = placed.axes * place.point;
    const Eigen::Vector3d normal = placed.axes * place.normal;
    const Eigen::Vector3d velocity = placed.velocity_at(arm);
    const double speed = velocity.dot(normal);
    Eigen::Vector3d slide = velocity - speed * normal;
    const double sliding = slide.norm();
    slide = sliding > 1e-9 ? Eigen::Vector3d(slide / sliding) : Eigen::Vector3d(normal.unitOrthogonal());
    if (robot_->space_dimension() == 2 && sliding <= 1e-9)
      slide = Eigen::Vector3d(-normal.y(), normal.x(), 0.0);
    const WhitenedWrench hn = placed.wrench_of(normal, arm);
    const WhitenedWrench ht = placed.wrench_of(slide, arm);
    const double nn = hn.squaredNorm(), nt = hn.dot(ht), tt = ht.squaredNorm();
    const double nF = hn.dot(scene.wrench), tF = ht.dot(scene.wrench);
    double weight = -1.0, against = 0.0;
    for (int k = -2; k <= 2; ++k) {
      const double mu = k * settings_.friction;             // of the force along -slide
      const double hh = nn + 2.0 * mu * nt + mu * mu * tt;  // times 1 + mu^2
      const double hF = -(nF + mu * tF);                    // times its root
      const double explained = hF > 0.0 && hh > 0.0 ? hF * hF / hh : 0.0;
      tally.explained = std::max(tally.explained, explained);
      if (tally.is_negligible(most_gain(explained))) continue;
      const double size = 1.0 / std::sqrt(1.0 + mu * mu);
      const ForceFit fit = fit_force(hh * size * size, hF * size, settings_.force_scale);
      if (tally.is_negligible(fit.log_gain)) continue;
      if (weight < 0.0) {
        weight =
            each * approach_weight(speed, settings_.object_speed) *
            room(scene, body.index(), body.index(), placed.origin + arm + settings_.object_radius * normal);
        against = normal_share(sliding / settings_.object_speed);  // friction against the sliding
      }
      const double share = k == 0 ? 1.0 / 3.0 : (k > 0 ? against : 1.0 - against) / 3.0;
      tally.add(weight * share, fit, place.fraction, speed);
    }
  }
}

void TouchHypotheses::weigh_clamping(const Scene& scene, int leg, Tally& tally) const {
  const auto first = static_cast<std::size_t>(BodyId::link1(leg).index());
  const auto second = static_cast<std::size_t>(BodyId::link2(leg).index());
  const LegPoints& points = (*scene.legs)[static_cast<std::size_t>(leg)];
  const Eigen::Vector3d elbow = in_space(points.passive_joint);
  const Eigen::Vector3d arms[] = {in_space(points.base_joint) - elbow,
                                  in_space(points.coupling_joint) - elbow};
  const double lengths[] = {arms[0].norm(), arms[1].norm()};
  const double shorter = std::min(lengths[0], lengths[1]);
  if (shorter <= 0.0 || scene.bodies[first].radius < 0.0 || scene.bodies[second].radius < 0.0) return;
  const Eigen::Vector3d along[] = {arms[0] / lengths[0], arms[1] / lengths[1]};
  const double cosine = along[0].dot(along[1]);
  if (std::abs(cosine) > 1.0 - 1e-6) return;  // links in one line: nothing is between them
  const double sine = std::sqrt(1.0 - cosine * cosine);
  const Eigen::Vector3d inwards[] = {(along[1] - cosine * along[0]) / sine,
                                     (along[0] - cosine * along[1]) / sine};
  const Eigen::Vector3d bisector = (along[0] + along[1]).normalized();
  const double cos_half = bisector.dot(along[0]);
  const std::size_t links[] = {first, second};
  const double each = 1.0 / settings_.points_along;
  const double scale = settings_.force_scale;
  for (int i = 0; i < settings_.points_along; ++i) {
    const double distance = shorter * (i + 0.5) / settings_.points_along;
    WhitenedWrench h[2];
    double closing = 0.0;
    for (int k = 0; k < 2; ++k) {
      const Placed& link = scene.bodies[links[k]];
      const Eigen::Vector3d arm = elbow + distance * along[k] + link.radius * inwards[k] - link.origin;
      h[k] = -link.wrench_of(inwards[k], arm);
      closing += link.velocity_at(arm).dot(inwards[k]);
    }
    // Two forces: precision P and mean m of what the wrench says of them with independent priors.
    Eigen::Matrix2d P;
    P << h[0].squaredNorm(), h[0].dot(h[1]), h[0].dot(h[1]), h[1].squaredNorm();
    P.diagonal().array() += 1.0 / (scale * scale);
    const Eigen::Vector2d hF(h[0].dot(scene.wrench), h[1].dot(scene.wrench));
    const Eigen::Matrix2d C = P.inverse();
    const Eigen::Vector2d m = C * hF;
    const double share = normal_share(m[0] / std::sqrt(C(0, 0))) * normal_share(m[1] / std::sqrt(C(1, 1)));
    if (!(share > 1e-12)) continue;
    ForceFit fit;
    fit.log_gain = 0.5 * m.dot(hF) + std::log(4.0 * share / (scale * scale) * std::sqrt(C.determinant()));
    fit.force = std::max(m[1], 0.0);
    const bool both_push = m[0] > 0.0 && m[1] > 0.0;
    fit.explained = both_push ? m.dot(hF) : 0.0;
    tally.explained = std::max(tally.explained, fit.explained);
    if (tally.is_negligible(fit.log_gain)) continue;
    const Eigen::Vector3d centre = elbow + distance / cos_half * bisector;
    const double weight = each * approach_weight(closing, settings_.closing_speed) *
                          room(scene, static_cast<int>(first), static_cast<int>(second), centre);
    tally.add(weight, fit, distance / lengths[1], closing);
  }
}

double TouchHypotheses::bias(int number) const {
  if (classes_.is_clamping(number)) return settings_.clamping_bias;
  const BodyId body = ContactClasses::body(number);
  if (body.is_platform()) return settings_.platform_bias;
  return body.is_link1() ? settings_.link1_bias : settings_.link2_bias;
}

void TouchHypotheses::place(const Kinematics& kinematics, const Eigen::LLT<PlatformMatrix>& S, BodyId body,
                            Placed& placed) const {
  const int directions = robot_->space_dimension();
  const CartesianVector origin = CartesianVector::Zero(directions);
  const ContactJacobian J = robot_->contact_jacobian(kinematics, body, origin);
  const auto turning = about_axes(J.rotation);
  placed.force.setZero();
  placed.force.topLeftCorner(robot_->dof(), directions) =
      S.matrixL().solve(PlatformMatrix(J.translation.transpose()));
  placed.moment.setZero();
  placed.moment.topRows(robot_->dof()) = S.matrixL().solve(PlatformMatrix(turning.transpose()));
  placed.velocity = in_space(J.translation * kinematics.velocity);
  placed.angular_velocity = turning * kinematics.velocity;
  placed.origin = in_space(robot_->point_on_body(kinematics, body, origin));
  placed.axes.setIdentity();
  for (int axis = 0; axis < directions; ++axis) {
    const CartesianVector unit = CartesianVector::Unit(directions, axis);
    placed.axes.col(axis) = in_space(robot_->point_on_body(kinematics, body, unit)) - placed.origin;
  }
  placed.begin = placed.end = placed.origin;
  for (const Shape& shape : robot_->body(body).shapes) {
    if (const auto* capsule = std::get_if<Capsule>(&shape)) {
      placed.begin = placed.origin + placed.axes * capsule->begin;
      placed.end = placed.origin + placed.axes * capsule->end;
      placed.radius = capsule->radius;
    } else if (const auto* sphere = std::get_if<Sphere>(&shape)) {
      placed.begin = placed.end = placed.origin + placed.axes * sphere->centre;
      placed.radius = sphere->radius;
    }
  }
}

void TouchHypotheses::weigh(const Kinematics& kinematics, const PlatformVector& wrench,
                            const PlatformMatrix& covariance, ContactEvidence& evidence) const noexcept {
  evidence.valid = false;
  for (ClassVector* entries : {&evidence.residual, &evidence.location, &evidence.force, &evidence.approach}) {
    entries->setZero(classes_.count());
  }
  evidence.log_evidence.setConstant(classes_.count(), impossible);
  if (!kinematics.valid || !usable(wrench, robot_->dof()) || !usable(kinematics.velocity, robot_->dof()))
    return;
  const Eigen::LLT<PlatformMatrix> S(covariance);
  if (S.info() != Eigen::Success || covariance.rows() != robot_->dof()) return;

  Scene scene;
  scene.legs = &kinematics.legs;
  scene.wrench.setZero();
  scene.wrench.head(robot_->dof()) = S.matrixL().solve(wrench);
  for (int i = 0; i < robot_->body_count(); ++i) {
    place(kinematics, S, BodyId::from_index(i), scene.bodies[static_cast<std::size_t>(i)]);
  }
  const double whole = scene.wrench.squaredNorm();
  for (int number = 0; number < classes_.count(); ++number) {
    Tally tally;
    if (classes_.is_clamping(number)) {
      weigh_clamping(scene, classes_.leg(number), tally);
    } else {
      weigh_body(scene, ContactClasses::body(number), tally);
    }
    evidence.residual[number] = std::max(whole - tally.explained, 0.0);
    if (tally.sum <= 0.0) continue;
    evidence.log_evidence[number] = tally.top + std::log(tally.sum) - 0.5 * whole + bias(number);
    evidence.location[number] = tally.location;
    evidence.force[number] = tally.force;
    evidence.approach[number] = tally.approach;
  }
  evidence.valid = evidence.log_evidence.allFinite();
}

}  // namespace flinch
