#include "systems/robot/legs/closed_form.h"

#include <Eigen/Geometry>
#include <cmath>

namespace flinch {
namespace {

constexpr double across = 1e-9;               // least that counts as not across, of unit vectors
constexpr double least_sine_squared = 1e-12;  // of the angle from a universal joint's first axis

double angle(const Eigen::Vector3d& axis, const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  return std::atan2(axis.dot(from.cross(to)), from.dot(to));
}

// The joints that move the tip: each the only one of its coordinate, so that the others follow them.
bool is_serial(const LegChain& chain, const std::vector<std::size_t>& path) {
  if (static_cast<int>(path.size()) != chain.coordinates) return false;
  std::vector<bool> met(path.size(), false);
  for (const std::size_t j : path) {
    const auto i = static_cast<std::size_t>(chain.joints[j].coordinate);
    if (met[i]) return false;
    met[i] = true;
  }
  return true;
}

}  // namespace

std::optional<ClosedForm> ClosedForm::of(const LegChain& chain, const std::vector<ChainClosure>& closures) {
  if (closures.size() != 1) return std::nullopt;
  const ChainClosure& closure = closures.front();
  const std::vector<std::size_t>& path = chain.paths[closure.joint];
  const std::size_t turning = closure.planar ? 1 : 2;
  if (closure.on != ChainClosure::On::platform || closure.holds_frame) return std::nullopt;
  if (path.size() != turning + 1 || !is_serial(chain, path)) return std::nullopt;

  ClosedForm form;
  form.is_arm_ = !chain.joints[path.back()].slides;
  form.first_ = form.is_arm_ ? path.front() : path.back();
  form.turns_.assign(form.is_arm_ ? path.begin() + 1 : path.begin(),
                     form.is_arm_ ? path.end() : path.end() - 1);
  for (const std::size_t j : form.turns_) {
    if (chain.joints[j].slides) return std::nullopt;
  }
  const ChainJoint& last = chain.joints[form.turns_.back()];
  if (form.has_two_axes()) {
    const ChainJoint& first = chain.joints[form.turns_.front()];
    if (last.at.norm() > 1e-12) return std::nullopt;
    const Eigen::Vector3d second_axis = first.turn * last.axis;
    if (std::abs(first.axis.dot(second_axis)) > across) return std::nullopt;
  }
  const ChainJoint& slide = chain.joints[form.first_];
  if (form.is_arm_) {
    form.rod_ = closure.at;
    form.length_ = closure.at.norm();
  } else {
    // The tip at q = 0 lies on the line of the slide through the point where the others turn.
    const Eigen::Vector3d at_zero = slide.at + slide.turn * closure.at;
    form.rod_ = slide.axis;
    form.length_ = at_zero.dot(slide.axis);
    if ((at_zero - form.length_ * slide.axis).norm() > 1e-12) return std::nullopt;
  }
  if (form.is_arm_ && form.length_ < 1e-9) return std::nullopt;
  // In the frame that moves with the last of them, whose axis is the same before and after.
  const Eigen::Vector3d own_axis = last.turn.transpose() * last.axis;
  if (std::abs(own_axis.dot(form.rod_.normalized())) > across) return std::nullopt;
  return form;
}

bool ClosedForm::solve(const LegChain& chain, const Eigen::Vector3d& target, const Assembly& assembly,
                       LegCoordinates& s) const noexcept {
  s.resize(chain.coordinates);
  if (is_arm_) {
    const auto elbow = reach(chain, target, assembly.bend, s);
    if (!elbow) return false;
    const Eigen::Vector3d way = target - elbow->origin - elbow->axes * chain.joints[turns_.front()].at;
    return point_at(chain, *elbow, way, assembly.turn, s);
  }
  const Frame from{chain.base, chain.axes};
  const Eigen::Vector3d way = target - from.origin - from.axes * chain.joints[turns_.front()].at;
  set(chain.joints[first_], assembly.bend * way.norm() - length_, s);
  return point_at(chain, from, assembly.bend * way, assembly.turn, s);
}

// Where the first joint of an arm must be, so that its elbow is a rod's length from the target. Returns the
// frame that moves with it.
std::optional<ClosedForm::Frame> ClosedForm::reach(const LegChain& chain, const Eigen::Vector3d& target,
                                                   double bend, LegCoordinates& s) const noexcept {
  const ChainJoint& joint = chain.joints[first_];
  const Eigen::Vector3d a = chain.axes * joint.axis;
  const Eigen::Vector3d origin = chain.base + chain.axes * joint.at;
  const Eigen::Matrix3d frame = chain.axes * joint.turn;
  const Eigen::Vector3d elbow = frame * chain.joints[turns_.front()].at;
  const double l2 = length_ * length_;
  if (joint.slides) {
    const Eigen::Vector3d D = target - origin - elbow;
    const double along = a.dot(D);
    const double radicand = l2 - D.squaredNorm() + along * along;
    if (!(radicand > 0.0)) return std::nullopt;
    const double q = along - bend * std::sqrt(radicand);
    set(joint, q, s);
    return Frame{origin + q * a, frame};
  }
  const double height = a.dot(elbow);
  const Eigen::Vector3d D = target - origin - height * a;
  const Eigen::Vector3d e = elbow - height * a;
  const double X = D.dot(e);
  const double Y = D.dot(a.cross(e));
  const double C = 0.5 * (D.squaredNorm() + e.squaredNorm() - l2);
  const double radicand = X * X + Y * Y - C * C;
  if (!(radicand > 0.0)) return std::nullopt;
  const double w = bend * std::sqrt(radicand);
  const double norm2 = X * X + Y * Y;
  const double cosine = (C * X + w * Y) / norm2;
  const double sine = (C * Y - w * X) / norm2;
  set(joint, std::atan2(sine, cosine), s);
  const Eigen::Matrix3d turned = joint.turn + sine * joint.turn_sin + (1.0 - cosine) * joint.turn_cos1;
  return Frame{origin, chain.axes * turned};
}

// Turns the rod into the direction of `way`. `from` carries the first of the joints.
bool ClosedForm::point_at(const LegChain& chain, const Frame& from, const Eigen::Vector3d& way, double turn,
                          LegCoordinates& s) const noexcept {
  const ChainJoint& first = chain.joints[turns_.front()];
  const Eigen::Vector3d a_1 = from.axes * first.axis;
  if (!has_two_axes()) {
    const Eigen::Matrix3d frame = from.axes * first.turn;
    if (!(way.squaredNorm() > 0.0)) return false;
    set(first, angle(a_1, frame * rod_, way), s);
    return true;
  }
  const ChainJoint& second = chain.joints[turns_.back()];
  const Eigen::Vector3d normal = a_1.cross(way);
  if (!(normal.squaredNorm() > least_sine_squared * way.squaredNorm())) return false;
  const Eigen::Vector3d a_2 = turn * normal.normalized();
  const Eigen::Vector3d a_2_zero = from.axes * (first.turn * second.axis);
  const double cosine = a_2_zero.dot(a_2);
  const double sine = a_1.dot(a_2_zero.cross(a_2));
  set(first, std::atan2(sine, cosine), s);
  const Eigen::Matrix3d turned = first.turn + sine * first.turn_sin + (1.0 - cosine) * first.turn_cos1;
  const Eigen::Vector3d rod = from.axes * (turned * (second.turn * rod_));
  set(second, angle(a_2, rod, way), s);
  return true;
}

}  // namespace flinch
