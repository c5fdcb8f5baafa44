#pragma once

#include <atomic>
#include <cstdint>

namespace flinch::test {

/// What is wrong with the sensors of a served rig, from now on.
struct Spoilt {
  std::atomic<bool> joints = false;    ///< an angle is no number
  std::atomic<bool> currents = false;  ///< a current is no number
  std::atomic<bool> imu = false;       ///< it has no reading
};

/// What 'flinch serve' does with the square scenario, but for `spoilt`. Never ends.
void serve_spoilt_rig(std::uint32_t domain, const Spoilt& spoilt);

}  // namespace flinch::test
