#include "systems/contact/touch_pairs.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>
#include <variant>

#include "systems/foundation/setup_error.h"
#include "systems/robot/contact_jacobian.h"
#include "systems/robot/decompositions.h"
#include "systems/robot/planar_leg.h"

namespace flinch {
namespace {

constexpr double impossible = -std::numeric_limits<double>::infinity();
constexpr std::size_t climbed = 8;        // summits of one or two contacts that are looked at
constexpr double least_force = 1.0;       // below which a force along the surface says nothing [N]
constexpr double finest_step = 1.0 / 64;  // of the coarse one

/// The most likely of what was tried, the best first.
template <class Start, std::size_t capacity>
class Best {
 public:
  void add(double score, const Start& start) {
    if (count_ == capacity && score <= scores_[count_ - 1]) return;
    if (count_ < capacity) ++count_;
    std::size_t at = count_ - 1;
    for (; at > 0 && scores_[at - 1] < score; --at) {
      scores_[at] = scores_[at - 1];
      starts_[at] = starts_[at - 1];
    }
    scores_[at] = score;
    starts_[at] = start;
  }
  std::size_t size() const { return count_; }
  double score(std::size_t i) const { return scores_[i]; }
  const Start& operator[](std::size_t i) const { return starts_[i]; }

 private:
  std::array<double, capacity> scores_{};
  std::array<Start, capacity> starts_{};
  std::size_t count_ = 0;
};

}  // namespace

struct TouchPairs::Scene {
  const Kinematics& at;
  Eigen::LLT<FeltMatrix> S;
  Felt felt;  // whitened
};

/// The best places about a start, and how likely all about them are together.
struct TouchPairs::Summit {
  double log_evidence = impossible;
  double residual = std::numeric_limits<double>::infinity();
  int count = 0;
  std::array<LocatedContact, 2> contacts;
};

/// The coarse places, side by side, and of a push at each the square of its norm with its prior, and its
/// product with what is felt.
struct TouchPairs::Places {
  static constexpr std::size_t most = 160;
  std::array<Touch, most> all;
  std::array<double, most> own, seen;
  std::array<std::size_t, most_sides + 1> first{};
};

/// All summits of one or two contacts together, and the best of them.
struct TouchPairs::Explained {
  double log_evidence = impossible;
  Summit best;

  void add(const Summit& found) {
    if (!(found.log_evidence > impossible)) return;
    const double greater = std::max(found.log_evidence, log_evidence);
    if (found.log_evidence > best.log_evidence) best = found;
    log_evidence = greater + std::log1p(std::exp(std::min(found.log_evidence, log_evidence) - greater));
  }
};

TouchPairs::TouchPairs(std::shared_ptr<const ParallelRobot> robot, std::shared_ptr<const LegBases> bases,
                       const TouchPairsSettings& settings)
    : robot_(std::move(robot)), bases_(std::move(bases)), settings_(settings) {
  if (!bases_ || robot_->space_dimension() != 2)
    throw SetupError("base forces: contacts are located with them on planar robots only");
  const auto& bodies = robot_->description().bodies;
  for (int body = 0; body < robot_->body_count(); ++body) {
    const Body& of = bodies[static_cast<std::size_t>(body)];
    const auto* const disc = of.shapes.size() == 1 ? std::get_if<Sphere>(&of.shapes.front()) : nullptr;
    const auto* const link = of.shapes.size() == 1 ? std::get_if<Capsule>(&of.shapes.front()) : nullptr;
    if (disc == nullptr && link == nullptr)
      throw SetupError("base forces: " + of.name + " must be one disc or one straight link");
    if (disc != nullptr) {
      sides_.push_back({.body = body,
                        .length = 2.0 * std::numbers::pi * disc->radius,
                        .radius = disc->radius,
                        .places = settings.places_around});
      continue;
    }
    const double length = (link->end - link->begin).norm();
    for (const double sign : {1.0, -1.0}) {
      sides_.push_back({.body = body,
                        .sign = sign,
                        .length = length,
                        .radius = link->radius,
                        .axis_begin = link->begin.x(),
                        .axis_length = length,
                        .places = settings.places_along});
    }
  }
  if (sides_.size() > most_sides) throw SetupError("base forces: the robot has too many bodies");
}

TouchPairs::Touch TouchPairs::touch(const Scene& scene, const Side& side, double place) const noexcept {
  const BodyId body = BodyId::from_index(side.body);
  Eigen::Vector2d in_body;
  Eigen::Vector2d normal_in_body;
  if (side.is_round()) {
    normal_in_body = unit_vector(2.0 * std::numbers::pi * place);
    in_body = side.radius * normal_in_body;
  } else {
    normal_in_body = {0.0, side.sign};
    in_body = {side.axis_begin + place * side.axis_length, side.sign * side.radius};
  }
  Touch touch;
  touch.side = &side;
  touch.place = place;
  touch.point = robot_->point_on_body(scene.at, body, in_body).head<2>();
  const Eigen::Vector2d inside = robot_->point_on_body(scene.at, body, in_body - normal_in_body).head<2>();
  touch.normal = touch.point - inside;
  const ContactJacobian moving = robot_->contact_jacobian(scene.at, body, in_body);
  const auto felt_of = [&](const Eigen::Vector2d& force, Felt& felt) {
    felt.setZero(scene.felt.size());
    felt.head(robot_->dof()) = moving.translation.transpose() * force;
    if (!body.is_platform()) {
      const int directions = bases_->directions();
      felt.segment(robot_->dof() + body.leg() * directions, directions) =
          bases_->felt(scene.at, body, touch.point, force);
    }
    scene.S.matrixL().solveInPlace(felt);
  };
  felt_of(-touch.normal, touch.push);
  felt_of(normal(touch.normal), touch.drag);
  return touch;
}

/// ln p(felt | these points) over that without a contact: pushes are half-normal, drags normal with their
/// share of what the pushes would be without any.
template <std::size_t n>
double TouchPairs::likelihood(const Scene& scene, const std::array<Touch, n>& touches,
                              Eigen::Matrix<double, 2 * static_cast<int>(n), 1>& forces) const noexcept {
  constexpr int count = static_cast<int>(n);
  using Pushes = Eigen::Matrix<double, count, 1>;
  using Square = Eigen::Matrix<double, 2 * count, 2 * count>;
  Square W;
  Eigen::Matrix<double, 2 * count, 1> seen;
  const auto column = [&](int k) -> const Felt& {
    const Touch& touch = touches[static_cast<std::size_t>(k % count)];
    return k < count ? touch.push : touch.drag;
  };
  for (int i = 0; i < 2 * count; ++i) {
    seen[i] = column(i).dot(scene.felt);
    for (int k = 0; k <= i; ++k) W(i, k) = W(k, i) = column(i).dot(column(k));
  }
  const double of_push = 1.0 / (settings_.force_scale * settings_.force_scale);
  Eigen::Matrix<double, count, count> alone = W.template topLeftCorner<count, count>();
  alone.diagonal().array() += of_push;
  const Pushes smooth = alone.llt().solve(seen.template head<count>());
  if (!(smooth.array() > 0.0).all()) return impossible;
  double log = static_cast<double>(n) * std::numbers::ln2;
  for (int i = 0; i < count; ++i) {
    const double drag = std::max(settings_.leaning * smooth[i], least_force);
    const double of_drag = 1.0 / (drag * drag);
    W(i, i) += of_push;
    W(count + i, count + i) += of_drag;
    log += 0.5 * std::log(of_push * of_drag);
  }
  const Eigen::LLT<Square> factor(W);
  forces = factor.solve(seen);
  if (!(forces.template head<count>().array() > 0.0).all()) return impossible;
  const Square L = factor.matrixL();
  return log + 0.5 * forces.dot(seen) - L.diagonal().array().log().sum();
}

/// Goes to the nearest summit of the likelihood by steps along each side that become shorter.
template <std::size_t n>
double TouchPairs::climb(const Scene& scene, std::array<Touch, n>& touches) const noexcept {
  Eigen::Matrix<double, 2 * static_cast<int>(n), 1> forces;
  double best = likelihood(scene, touches, forces);
  for (double share = 0.5; share >= finest_step; share *= 0.5) {
    for (std::size_t i = 0; i < n; ++i) {
      for (const double way : {share, -share}) {
        std::array<Touch, n> tried = touches;
        const Side& side = *touches[i].side;
        double place = touches[i].place + way * step(side);
        if (!side.is_round()) place = std::clamp(place, 0.0, 1.0);
        tried[i] = touch(scene, side, place);
        const double found = likelihood(scene, tried, forces);
        if (!(found > best)) continue;
        best = found;
        touches = tried;
        break;
      }
    }
  }
  return best;
}

template <std::size_t n>
TouchPairs::Summit TouchPairs::summit(const Scene& scene, std::array<Touch, n> touches) const noexcept {
  constexpr int count = static_cast<int>(n);
  using Square = Eigen::Matrix<double, count, count>;
  Summit found;
  const double top = climb(scene, touches);
  if (!(top > impossible)) return found;
  Eigen::Matrix<double, 2 * count, 1> forces, unused;
  likelihood(scene, touches, forces);
  Felt left = scene.felt;
  for (std::size_t i = 0; i < n; ++i)
    left -=
        touches[i].push * forces[static_cast<int>(i)] + touches[i].drag * forces[count + static_cast<int>(i)];

  // Curvature over the sides' coordinates [m], by differences; a flat summit counts as the whole side.
  Square curvature;
  const auto moved = [&](std::size_t i, double a, std::size_t k, double b) {
    std::array<Touch, n> there = touches;
    const auto move = [&](std::size_t which, double by) {
      const Side& side = *there[which].side;
      there[which] = touch(scene, side, there[which].place + by * 0.25 * step(side));
    };
    move(i, a);
    if (k != i) move(k, b);
    const double value = likelihood(scene, there, unused);
    return value > impossible ? value : top - 10.0;
  };
  const auto stretch = [&](std::size_t i) { return 0.25 * step(*touches[i].side) * touches[i].side->length; };
  for (std::size_t i = 0; i < n; ++i) {
    const int row = static_cast<int>(i);
    const double h = stretch(i);
    const double widest = 12.0 / (touches[i].side->length * touches[i].side->length);
    curvature(row, row) = std::max((2.0 * top - moved(i, 1, i, 0) - moved(i, -1, i, 0)) / (h * h), widest);
    for (std::size_t k = 0; k < i; ++k) {
      const int column = static_cast<int>(k);
      const double mixed =
          (moved(i, 1, k, 1) - moved(i, 1, k, -1) - moved(i, -1, k, 1) + moved(i, -1, k, -1)) /
          (4.0 * h * stretch(k));
      const double most = 0.99 * std::sqrt(curvature(row, row) * curvature(column, column));
      curvature(row, column) = curvature(column, row) = std::clamp(-mixed, -most, most);
    }
  }
  const Square covariance = curvature.inverse();
  found.log_evidence =
      top + 0.5 * count * std::log(2.0 * std::numbers::pi) + 0.5 * std::log(covariance.determinant());
  found.residual = left.squaredNorm();
  found.count = count;
  for (std::size_t i = 0; i < n; ++i) {
    const Touch& touch = touches[i];
    const int row = static_cast<int>(i);
    found.log_evidence -= std::log(touch.side->length);
    found.contacts[i] = {
        .body = touch.side->body,
        .fraction = touch.side->is_round() ? 0.0 : touch.place,
        .point_in_base = touch.point,
        .force_in_base = -forces[row] * touch.normal + forces[count + row] * normal(touch.normal),
        .point_deviation = std::sqrt(covariance(row, row))};
  }
  return found;
}

/// Of wrench and base forces together. What both are behind by while forces grow is left out: it scales all
/// that is felt alike, and says nothing of how many contacts there are.
TouchPairs::FeltMatrix TouchPairs::covariance(const PlatformMatrix& of_wrench,
                                              const BaseForceEstimate& bases) const noexcept {
  const int n = robot_->dof();
  const int size = n + bases_->size();
  const int directions = bases_->directions();
  FeltMatrix S = FeltMatrix::Zero(size, size);
  S.topLeftCorner(n, n) = of_wrench;
  for (int leg = 0; leg < bases_->legs(); ++leg) {
    const double share =
        settings_.share_of_force * bases.force_in_base.segment(leg * directions, directions).norm();
    S.diagonal()
        .segment(n + leg * directions, directions)
        .setConstant(settings_.base_force * settings_.base_force + share * share);
  }
  return S;
}

void TouchPairs::try_places(const Scene& scene, Places& places) const noexcept {
  const double of_push = 1.0 / (settings_.force_scale * settings_.force_scale);
  std::size_t count = 0;
  for (std::size_t side = 0; side < sides_.size(); ++side) {
    places.first[side] = count;
    for (int k = 0; k < sides_[side].places && count < Places::most; ++k, ++count) {
      places.all[count] = touch(scene, sides_[side], (k + 0.5) * step(sides_[side]));
      places.own[count] = places.all[count].push.squaredNorm() + of_push;
      places.seen[count] = places.all[count].push.dot(scene.felt);
    }
  }
  places.first[sides_.size()] = count;
}

// Starts by pushes alone: ln p = b^2 / 2a - ln(a) / 2 with a = |push|^2 and b = push . felt, whitened.
TouchPairs::Explained TouchPairs::by_one(const Scene& scene, const Places& places) const noexcept {
  Best<std::size_t, climbed> starts;
  for (std::size_t side = 0; side < sides_.size(); ++side) {
    Best<std::size_t, 1> best;
    for (std::size_t i = places.first[side]; i < places.first[side + 1]; ++i) {
      const double own = places.own[i], seen = places.seen[i];
      if (seen > 0.0) best.add(0.5 * (seen * seen / own - std::log(own)), i);
    }
    if (best.size() > 0) starts.add(best.score(0), best[0]);
  }
  Explained found;
  for (std::size_t i = 0; i < starts.size(); ++i) found.add(summit<1>(scene, {places.all[starts[i]]}));
  found.log_evidence -= std::log(robot_->body_count());
  return found;
}

// The same of two pushes x, y >= 0: (a_i, c; c, a_k) (x, y) = (b_i, b_k) with c = push_i . push_k.
TouchPairs::Explained TouchPairs::by_two(const Scene& scene, const Places& places) const noexcept {
  using Pair = std::pair<std::size_t, std::size_t>;
  Best<Pair, climbed> starts;
  for (std::size_t a = 0; a < sides_.size(); ++a) {
    for (std::size_t b = 0; b < a; ++b) {
      if (sides_[a].body == sides_[b].body) continue;
      Best<Pair, 1> best;
      for (std::size_t i = places.first[a]; i < places.first[a + 1]; ++i) {
        for (std::size_t k = places.first[b]; k < places.first[b + 1]; ++k) {
          const double both = places.all[i].push.dot(places.all[k].push);
          const double determinant = places.own[i] * places.own[k] - both * both;
          const double x = places.own[k] * places.seen[i] - both * places.seen[k];
          const double y = places.own[i] * places.seen[k] - both * places.seen[i];
          if (!(x > 0.0) || !(y > 0.0) || !(determinant > 0.0)) continue;
          best.add(0.5 * ((x * places.seen[i] + y * places.seen[k]) / determinant - std::log(determinant)),
                   {i, k});
        }
      }
      if (best.size() > 0) starts.add(best.score(0), best[0]);
    }
  }
  Explained found;
  for (std::size_t i = 0; i < starts.size(); ++i)
    found.add(summit<2>(scene, {places.all[starts[i].first], places.all[starts[i].second]}));
  const double bodies = robot_->body_count();
  found.log_evidence -= std::log(0.5 * bodies * (bodies - 1.0));
  return found;
}

void TouchPairs::find(const Kinematics& at, const PlatformVector& wrench, const PlatformMatrix& of_wrench,
                      const BaseForceEstimate& bases, LocatedContacts& out) const noexcept {
  out = LocatedContacts();
  if (!at.valid || !bases.valid || wrench.size() != robot_->dof()) return;
  if (bases.force_in_base.size() != bases_->size()) return;
  Scene scene{at, Eigen::LLT<FeltMatrix>(covariance(of_wrench, bases)), Felt()};
  if (scene.S.info() != Eigen::Success) return;
  scene.felt.resize(wrench.size() + bases.force_in_base.size());
  scene.felt << wrench, bases.force_in_base;
  scene.S.matrixL().solveInPlace(scene.felt);
  if (!scene.felt.allFinite()) return;
  Places places;
  try_places(scene, places);
  const Explained one = by_one(scene, places), two = by_two(scene, places);
  out.valid = one.best.count > 0 || two.best.count > 0;
  if (!out.valid) return;
  constexpr double certain = 1e3;
  const double odds = one.best.count == 0   ? certain
                      : two.best.count == 0 ? -certain
                                            : two.log_evidence - one.log_evidence;
  out.log_odds_of_two = std::clamp(odds, -certain, certain);
  const Summit& said = out.log_odds_of_two > settings_.least_log_odds ? two.best : one.best;
  if (!(said.residual <= settings_.largest_residual)) return;
  out.count = said.count;
  out.contacts = said.contacts;
}

}  // namespace flinch
