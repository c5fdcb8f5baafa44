#pragma once

#include <array>
#include <cstdint>

namespace flinch {

/// What a program is to the bus, which decides what it may send where the bus is secured.
enum class BusRole : std::uint8_t {
  controller,  ///< commands, and shows what it does
  robot,       ///< has the drives and sensors
  observer,    ///< only listens
};

inline constexpr std::array all_bus_roles = {BusRole::controller, BusRole::robot, BusRole::observer};

constexpr const char* name(BusRole role) {
  switch (role) {
    case BusRole::controller:
      return "controller";
    case BusRole::robot:
      return "robot";
    case BusRole::observer:
      return "observer";
  }
  return "";
}

}  // namespace flinch
