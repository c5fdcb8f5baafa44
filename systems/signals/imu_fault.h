#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace flinch {

/// What seems to be wrong with the inertial measurement unit. Nobody uses what it says meanwhile.
enum class ImuFault : std::uint8_t {
  none,
  dropped_out,   ///< it has been there and says nothing any more
  frozen,        ///< it repeats itself to the last bit
  saturated,     ///< an axis stands at its end while the others go on
  noisy,         ///< it has much more noise than at rest
  late,          ///< it tells of another time than its stamps say
  biased,        ///< it is off by a constant
  turned,        ///< its axes are not where they should be
  contradicted,  ///< encoders and model agree on another motion, and none of these explains it
};

inline constexpr std::array<const char*, 9> imu_fault_names{
    "none", "dropped out", "frozen", "saturated", "noisy", "late", "biased", "turned", "contradicted"};

inline const char* name(ImuFault doubt) { return imu_fault_names[static_cast<std::size_t>(doubt)]; }

}  // namespace flinch
