#pragma once

#include <cmath>
#include <numbers>

namespace flinch {

/// Beyond which the share of a standard normal distribution counts as 0, or 1: there it is 1e-12 from it.
inline constexpr double farthest_normal = 7.03;

/// exp(z^2 / 2) times the share of a standard normal distribution beyond z, for z from 0 to
/// `farthest_normal`; within 3e-9 of its value. Hart et al., Computer Approximations (1968), 5666.
inline double normal_tail(double z) noexcept {
  const double above =
      (((((3.52624965998911e-02 * z + 0.700383064443688) * z + 6.37396220353165) * z + 33.912866078383) * z +
        112.079291497871) *
           z +
       221.213596169931) *
          z +
      220.206867912376;
  const double below =
      ((((((8.83883476483184e-02 * z + 1.75566716318264) * z + 16.064177579207) * z + 86.7807322029461) * z +
         296.564248779674) *
            z +
        637.333633378831) *
           z +
       793.826512519948) *
          z +
      440.413735824752;
  return above / below;
}

/// Share of a standard normal distribution below x.
inline double normal_share(double x) noexcept {
  const double z = std::abs(x);
  const double beyond = z < farthest_normal ? std::exp(-0.5 * z * z) * normal_tail(z) : 0.0;
  return x > 0.0 ? 1.0 - beyond : beyond;
}

/// E[max(x - w, 0)] for standard normal w.
inline double normal_excess(double x) noexcept {
  const double z = std::abs(x);
  constexpr double density_at_0 = 0.5 * std::numbers::inv_sqrtpi * std::numbers::sqrt2;
  const double excess =
      z < farthest_normal ? std::exp(-0.5 * z * z) * (density_at_0 - z * normal_tail(z)) : 0.0;
  return x > 0.0 ? x + excess : excess;
}

}  // namespace flinch
