#include "systems/contact/touch_hypotheses.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <utility>

#include "systems/contact/normal_share.h"
#include "systems/contact/touch_tally.h"
#include "systems/contact/wrench_line.h"
#include "systems/foundation/findings.h"
#include "systems/foundation/setup_error.h"
#include "systems/robot/decompositions.h"
#include "systems/robot/outline.h"

namespace flinch {
namespace {

constexpr double impossible = -1e6;
constexpr int tried_across = 7;       // rays along the line of action, in each of two directions
constexpr double grazing = 0.1;       // cosine of a force against the normal below which no place is tried
constexpr double surely_free = 20.0;  // softnesses away: what is there leaves a room of 1, within 2e-9

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

/// E[max(v - w, 0)] for w ~ N(0, sigma^2) [m/s].
double approach_weight(double v, double sigma) { return sigma * normal_excess(v / sigma); }

constexpr std::array frictions{-2.0, -1.0, 0.0, 1.0, 2.0};  // times the coefficient, along the sliding

/// Friction that is tried: its coefficient mu, and the share 1 / (1 + mu^2) of the square of a force that is
/// then along the normal, with its root.
struct Friction {
  double mu, share, root;
};
using Frictions = std::array<Friction, frictions.size()>;

Frictions frictions_of(double coefficient) {
  Frictions tried;
  for (std::size_t k = 0; k < tried.size(); ++k) {
    const double mu = frictions[k] * coefficient, share = 1.0 / (1.0 + mu * mu);
    tried[k] = {mu, share, std::sqrt(share)};
  }
  return tried;
}

/// A direction in which a surface may slide; in the plane there is one, and its opposite.
Eigen::Vector3d tangent_to(const Eigen::Vector3d& normal, int dimension) {
  if (dimension == 2) return {-normal.y(), normal.x(), 0.0};
  return normal.unitOrthogonal();
}

/// A value that changes linearly from place to place: a + b x.
template <class Value>
struct Linear {
  Value a, b;
  double operator()(double x) const { return a + b * x; }
};

template <class Vector, class Direction>
Linear<double> along(const Linear<Vector>& vector, const Direction& direction) {
  return {vector.a.dot(direction), vector.b.dot(direction)};
}

/// a + b x + c x^2
struct Quadratic {
  double a, b, c;
  double operator()(double x) const { return a + (b + c * x) * x; }
};

template <class Vector>
Quadratic product(const Linear<Vector>& v, const Linear<Vector>& w) {
  return {v.a.dot(w.a), v.a.dot(w.b) + v.b.dot(w.a), v.b.dot(w.b)};
}

}  // namespace

/// What is the same for all classes at one instant. L L^T = S whitens wrenches.
struct TouchHypotheses::Scene {
  const std::array<LegPoints, max_dof>* legs = nullptr;
  std::array<Placed, max_bodies> bodies;
  WhitenedWrench wrench;             // L^-1 F
  const WrenchLine* line = nullptr;  // on the platform; none: it is not known closely
  Frictions frictions;               // against the sliding
};

/// A place that is touched: whitened wrenches of forces of 1 N along the normal and the sliding there.
struct TouchHypotheses::Touch {
  double nn, nt, tt;       // their products
  double nF, tF;           // with the wrench
  double speed, sliding;   // [m/s]
  Eigen::Vector3d arm;     // from the body's origin
  Eigen::Vector3d normal;  // outwards, in the base frame
};

TouchHypotheses::TouchHypotheses(std::shared_ptr<const ParallelRobot> robot,
                                 const TouchHypothesesSettings& settings)
    : robot_(std::move(robot)),
      settings_(settings),
      classes_(robot_->body_count(), robot_->legs()),
      places_(static_cast<std::size_t>(robot_->body_count())),
      sides_(places_.size()),
      platform_(robot_->body(BodyId::platform()).shapes) {
  Findings found("contact hypotheses: ");
  found.positive("force_scale", settings.force_scale, "N");
  found.positive("object_speed", settings.object_speed, "m/s");
  found.positive("object_radius", settings.object_radius, "m");
  found.positive("softness", settings.softness, "m");
  found.positive("closing_speed", settings.closing_speed, "m/s");
  found.not_negative("friction", settings.friction);
  found.require(settings.points_along > 0 && settings.points_around > 0 && settings.places_in_space > 0 &&
                    settings.sides_in_space > 0 && settings.places_along_in_space > 0,
                "there must be places to try");
  throw_if_any(found.take());
  for (int i = 0; i < robot_->body_count(); ++i) add_places(BodyId::from_index(i));
}

void TouchHypotheses::add_places(BodyId body) {
  std::vector<TouchPlace>& places = places_[static_cast<std::size_t>(body.index())];
  std::vector<Side>& sides = sides_[static_cast<std::size_t>(body.index())];
  const int dimension = robot_->space_dimension();
  const auto add = [&](const std::vector<TouchPlace>& more, std::size_t together) {
    for (std::size_t first = 0; first < more.size(); first += together)
      sides.push_back({places.size() + first, together});
    places.insert(places.end(), more.begin(), more.end());
  };
  if (dimension == 3 && body.is_platform()) {
    const OutlinePlaces all = places_by_area(robot_->body(body).shapes, settings_.places_in_space);
    area_each_ = all.area_each;
    return add(all.places, 1);
  }
  const int sides_of_link = dimension == 2 ? 2 : settings_.sides_in_space;
  const int along = dimension == 2 ? settings_.points_along : settings_.places_along_in_space;
  for (const Shape& shape : robot_->body(body).shapes) {
    const auto* capsule = std::get_if<Capsule>(&shape);
    if (capsule == nullptr) {
      add(places_around(shape, dimension, settings_.points_around), 1);
      continue;
    }
    const Eigen::Vector3d axis = (capsule->end - capsule->begin).normalized();
    const Eigen::Vector3d across =
        dimension == 2 ? Eigen::Vector3d::UnitZ().cross(axis) : axis.unitOrthogonal();
    for (const Eigen::Vector3d& turned : even_directions(2, sides_of_link)) {
      const Eigen::Vector3d normal = turned.x() * across + turned.y() * axis.cross(across);
      add(places_along(*capsule, normal, along), static_cast<std::size_t>(along));
    }
  }
}

double TouchHypotheses::room(const Scene& scene, int body, int other, const Eigen::Vector3d& centre) const {
  double room = 1.0;
  for (int i = 0; i < robot_->body_count(); ++i) {
    const Placed& placed = scene.bodies[static_cast<std::size_t>(i)];
    if (i == body || i == other || placed.radius < 0.0) continue;
    const Eigen::Vector3d apart = centre - placed.begin;
    const double fraction = std::clamp(apart.dot(placed.by_length), 0.0, 1.0);
    const double distance = (apart - fraction * (placed.end - placed.begin)).squaredNorm();
    const double touching = placed.radius + settings_.object_radius;
    const double free = touching + surely_free * settings_.softness;
    if (distance > free * free) continue;
    room *= 1.0 / (1.0 + std::exp((touching - std::sqrt(distance)) / settings_.softness));
  }
  return room;
}

void TouchHypotheses::add(const Scene& scene, BodyId body, const TouchPlace& place, const Touch& touch,
                          TouchTally& tally) const {
  const double rare = 1.0 / (settings_.force_scale * settings_.force_scale);
  std::array<double, frictions.size()> hh, hF;
  std::array<bool, frictions.size()> matters;
  for (std::size_t k = 0; k < frictions.size(); ++k) {
    const auto& [mu, shrink, root] = scene.frictions[k];
    hh[k] = (touch.nn + 2.0 * mu * touch.nt + mu * mu * touch.tt) * shrink;
    hF[k] = -(touch.nF + mu * touch.tF);
    const double squared = hF[k] > 0.0 ? hF[k] * hF[k] * shrink : 0.0;
    hF[k] *= root;
    if (squared > tally.explained * hh[k]) tally.explained = squared / hh[k];
    matters[k] = squared >= 2.0 * (tally.top - TouchTally::negligible) * (hh[k] + rare);
  }
  if (std::none_of(matters.begin(), matters.end(), std::identity())) return;
  const Placed& placed = scene.bodies[static_cast<std::size_t>(body.index())];
  const double weight = place.share * approach_weight(touch.speed, settings_.object_speed) *
                        room(scene, body.index(), body.index(),
                             placed.origin + touch.arm + settings_.object_radius * touch.normal);
  const double against =
      normal_share(touch.sliding / settings_.object_speed);  // friction against the sliding
  for (std::size_t k = 0; k < frictions.size(); ++k) {
    if (!matters[k]) continue;
    const double s = 1.0 / std::sqrt(hh[k] + rare);
    const double x = hF[k] * s;  // m / s of the class's comment
    if (x > 0.0) tally.make_room(0.5 * x * x);
    const double share = frictions[k] == 0.0 ? 1.0 : (frictions[k] > 0.0 ? against : 1.0 - against);
    tally.add(weight * share / 3.0 * s * tally.likelihood(x), place.fraction, std::max(x * s, 0.0),
              touch.speed);
  }
}

/// On a straight side, all of which has one normal, velocities and wrenches are linear in the place.
void TouchHypotheses::weigh_side(const Scene& scene, BodyId body, const Side& side, TouchTally& tally) const {
  const auto at = static_cast<std::size_t>(body.index());
  const Placed& placed = scene.bodies[at];
  const TouchPlace* const places = &places_[at][side.first];
  const Eigen::Vector3d begin = placed.axes * places[0].point;
  const Eigen::Vector3d step =
      (placed.axes * places[side.count - 1].point - begin) / static_cast<double>(side.count - 1);
  const Eigen::Vector3d normal = placed.axes * places[0].normal;
  const Eigen::Vector3d tangent = tangent_to(normal, robot_->space_dimension());
  const std::array<Eigen::Vector3d, 2> tangents{tangent, normal.cross(tangent)};
  const Linear<Eigen::Vector3d> velocity{placed.velocity_at(begin), placed.angular_velocity.cross(step)};
  const auto wrench_along = [&](const Eigen::Vector3d& direction) {
    return Linear<WhitenedWrench>{placed.wrench_of(direction, begin), placed.moment * step.cross(direction)};
  };
  const auto hn = wrench_along(normal);
  const std::array ht{wrench_along(tangents[0]), wrench_along(tangents[1])};
  const Quadratic nn = product(hn, hn), n0 = product(hn, ht[0]), n1 = product(hn, ht[1]);
  const Quadratic t00 = product(ht[0], ht[0]), t01 = product(ht[0], ht[1]), t11 = product(ht[1], ht[1]);
  const auto nF = along(hn, scene.wrench);
  const std::array tF{along(ht[0], scene.wrench), along(ht[1], scene.wrench)};
  const auto speed = along(velocity, normal);
  const std::array slides{along(velocity, tangents[0]), along(velocity, tangents[1])};
  for (std::size_t i = 0; i < side.count; ++i) {
    const auto x = static_cast<double>(i);
    const double slide0 = slides[0](x), slide1 = slides[1](x), sliding = std::hypot(slide0, slide1);
    const double c0 = sliding > 1e-9 ? slide0 / sliding : 1.0, c1 = sliding > 1e-9 ? slide1 / sliding : 0.0;
    const Touch touch{.nn = nn(x),
                      .nt = c0 * n0(x) + c1 * n1(x),
                      .tt = c0 * c0 * t00(x) + 2.0 * c0 * c1 * t01(x) + c1 * c1 * t11(x),
                      .nF = nF(x),
                      .tF = c0 * tF[0](x) + c1 * tF[1](x),
                      .speed = speed(x),
                      .sliding = sliding,
                      .arm = begin + x * step,
                      .normal = normal};
    add(scene, body, places[i], touch, tally);
  }
}

void TouchHypotheses::weigh_place(const Scene& scene, BodyId body, const TouchPlace& place,
                                  TouchTally& tally) const {
  const Placed& placed = scene.bodies[static_cast<std::size_t>(body.index())];
  const Eigen::Vector3d arm = placed.axes * place.point;
  const Eigen::Vector3d normal = placed.axes * place.normal;
  const Eigen::Vector3d velocity = placed.velocity_at(arm);
  const double speed = velocity.dot(normal);
  Eigen::Vector3d slide = velocity - speed * normal;
  const double sliding = slide.norm();
  slide = sliding > 1e-9 ? Eigen::Vector3d(slide / sliding) : tangent_to(normal, robot_->space_dimension());
  const WhitenedWrench hn = placed.wrench_of(normal, arm);
  const WhitenedWrench ht = placed.wrench_of(slide, arm);
  const Touch touch{.nn = hn.squaredNorm(),
                    .nt = hn.dot(ht),
                    .tt = ht.squaredNorm(),
                    .nF = hn.dot(scene.wrench),
                    .tF = ht.dot(scene.wrench),
                    .speed = speed,
                    .sliding = sliding,
                    .arm = arm,
                    .normal = normal};
  add(scene, body, place, touch, tally);
}

/// Rays along the line of action, each for its part of the outline, in the place of the places near it.
void TouchHypotheses::weigh_platform(const Scene& scene, TouchTally& tally) const {
  const BodyId body = BodyId::platform();
  const WrenchLine& line = *scene.line;
  for (const TouchPlace& place : places_[0]) {
    if (!line.passes(place.point)) weigh_place(scene, body, place, tally);
  }
  const double step = 2.0 * line.reach / tried_across;
  for (int i = 0; i < tried_across * tried_across; ++i) {
    const int row = i / tried_across, column = i % tried_across;
    const double a = (column + 0.5) * step - line.reach, b = (row + 0.5) * step - line.reach;
    const Eigen::Vector3d beside = line.point + a * line.across[0] + b * line.across[1];
    const LinePassage passage = platform_.passage(beside, line.direction);
    if (!passage.hits) continue;
    const Eigen::Vector3d point = beside + passage.enter * line.direction;
    const Eigen::Vector3d normal = platform_.normal_at(point);
    const double facing = -normal.dot(line.direction);
    if (facing > grazing)
      weigh_place(scene, body, {point, normal, 0.0, step * step / (facing * area_each_)}, tally);
  }
}

void TouchHypotheses::weigh_body(const Scene& scene, BodyId body, TouchTally& tally) const {
  const auto at = static_cast<std::size_t>(body.index());
  if (body.is_platform() && scene.line != nullptr) {
    weigh_platform(scene, tally);
  } else {
    for (const Side& side : sides_[at]) {
      if (side.count > 1) {
        weigh_side(scene, body, side, tally);
      } else {
        weigh_place(scene, body, places_[at][side.first], tally);
      }
    }
  }
  tally.sum *= 2.0 / (settings_.force_scale * static_cast<double>(places_[at].size()));
}

void TouchHypotheses::weigh_clamping(const Scene& scene, int leg, TouchTally& tally) const {
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
    const bool both_push = m[0] > 0.0 && m[1] > 0.0;
    const double gain = 0.5 * m.dot(hF);  // where both push: not more than this
    if (both_push) tally.explained = std::max(tally.explained, 2.0 * gain);
    const double share = normal_share(m[0] / std::sqrt(C(0, 0))) * normal_share(m[1] / std::sqrt(C(1, 1)));
    if (!(share > 1e-12)) continue;
    const double logarithm = gain + std::log(share);
    if (tally.is_negligible(logarithm)) continue;
    tally.make_room(logarithm);
    const Eigen::Vector3d centre = elbow + distance / cos_half * bisector;
    const double weight = approach_weight(closing, settings_.closing_speed) *
                          room(scene, static_cast<int>(first), static_cast<int>(second), centre);
    tally.add(weight * std::sqrt(C.determinant()) * std::exp(logarithm - tally.unit), distance / lengths[1],
              std::max(m[1], 0.0), closing);
  }
  tally.sum *= 4.0 / (scale * scale * settings_.points_along);
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
      const Eigen::Vector3d axis = placed.end - placed.begin;
      if (axis.squaredNorm() > 0.0) placed.by_length = axis / axis.squaredNorm();
    } else if (const auto* sphere = std::get_if<Sphere>(&shape)) {
      placed.begin = placed.end = placed.origin + placed.axes * sphere->centre;
      placed.radius = sphere->radius;
    }
  }
}

void TouchHypotheses::weigh(const Kinematics& kinematics, const PlatformVector& wrench,
                            const PlatformMatrix& covariance, ContactEvidence& evidence) const noexcept {
  evidence.valid = false;
  for (ClassVector* entries : {&evidence.residual, &evidence.location, &evidence.force, &evidence.approach})
    entries->setZero(classes_.count());
  evidence.log_evidence.setConstant(classes_.count(), impossible);
  if (!kinematics.valid || !usable(wrench, robot_->dof()) || !usable(kinematics.velocity, robot_->dof()))
    return;
  const Eigen::LLT<PlatformMatrix> S(covariance);
  if (S.info() != Eigen::Success || covariance.rows() != robot_->dof()) return;

  Scene scene;
  scene.legs = &kinematics.legs;
  scene.frictions = frictions_of(settings_.friction);
  scene.wrench.setZero();
  scene.wrench.head(robot_->dof()) = S.matrixL().solve(wrench);
  for (int i = 0; i < robot_->body_count(); ++i)
    place(kinematics, S, BodyId::from_index(i), scene.bodies[static_cast<std::size_t>(i)]);
  std::optional<WrenchLine> line;
  if (robot_->space().rotations() == 3)
    line.emplace(robot_->space(), wrench, covariance, scene.bodies[0].axes);
  if (line && line->reach * 2.0 / tried_across < std::sqrt(area_each_)) scene.line = &*line;
  const double whole = scene.wrench.squaredNorm();
  for (int number = 0; number < classes_.count(); ++number) {
    TouchTally tally;
    if (classes_.is_clamping(number)) {
      weigh_clamping(scene, classes_.leg(number), tally);
    } else {
      weigh_body(scene, ContactClasses::body(number), tally);
    }
    evidence.residual[number] = std::max(whole - tally.explained, 0.0);
    if (tally.sum <= 0.0) continue;
    evidence.log_evidence[number] = tally.unit + std::log(tally.sum) - 0.5 * whole + bias(number);
    evidence.location[number] = tally.location;
    evidence.force[number] = tally.force;
    evidence.approach[number] = tally.approach;
  }
  evidence.valid = evidence.log_evidence.allFinite();
}

}  // namespace flinch
