#include "systems/robot/legs/leg_closure.h"

namespace flinch {

void ChainClosure::residual(const ChainPlace& place, const PlatformTwist& platform, int first,
                            ClosureVector& e) const noexcept {
  Eigen::Vector3d x_B = on_at;
  Eigen::Matrix3d R_B = on_turn;
  if (on == On::platform) {
    x_B = platform.origin + platform.axes * on_at;
    R_B = platform.axes * on_turn;
  } else if (on == On::joint) {
    x_B = place.origin[on_joint] + place.axes[on_joint] * on_at;
    R_B = place.axes[on_joint] * on_turn;
  }
  const Eigen::Vector3d missed = x_B - point(place);
  Eigen::Vector3d turned(0.0, 0.0, 0.0);
  if (holds_frame) turned = rotation_log(R_B * (place.axes[joint] * turn).transpose());
  write(missed, turned, first, 0, e);
}

void ChainClosure::rows_of_leg(const LegChain& chain, const ChainPlace& place, int first,
                               ClosureMatrix& J) const noexcept {
  PointColumns a, b;
  chain.columns(place, joint, point(place), a);
  const bool on_link = on == On::joint;
  if (on_link) chain.columns(place, on_joint, place.origin[on_joint] + place.axes[on_joint] * on_at, b);
  for (int i = 0; i < chain.coordinates; ++i) {
    const auto m = static_cast<std::size_t>(i);
    if (on_link) {
      a.v[m] -= b.v[m];
      a.w[m] -= b.w[m];
    }
    write(a.v[m], a.w[m], first, i, J);
  }
}

void ChainClosure::rows_of_leg(const LegChain& chain, const ChainPlace& place, const ChainRates& rates,
                               int first, ClosureMatrix& J, ClosureMatrix& dJ) const noexcept {
  const auto columns = [&](std::size_t of, const Eigen::Vector3d& in_link, PointColumns& out) {
    const Eigen::Vector3d arm = place.axes[of] * in_link;
    chain.columns(place, rates, of, place.origin[of] + arm, rates.velocity[of] + rates.omega[of].cross(arm),
                  out);
  };
  PointColumns a, b;
  columns(joint, at, a);
  const bool on_link = on == On::joint;
  if (on_link) columns(on_joint, on_at, b);
  for (int i = 0; i < chain.coordinates; ++i) {
    const auto m = static_cast<std::size_t>(i);
    if (on_link) {
      a.v[m] -= b.v[m];
      a.w[m] -= b.w[m];
      a.dv[m] -= b.dv[m];
      a.dw[m] -= b.dw[m];
    }
    write(a.v[m], a.w[m], first, i, J);
    write(a.dv[m], a.dw[m], first, i, dJ);
  }
}

}  // namespace flinch
