#pragma once

#include <drivers/idl/flinch.h>

#include <functional>
#include <string>
#include <vector>

#include "tests/support/other_program.h"

namespace flinch::test {

inline constexpr std::uint32_t strangers_session = 666;
inline constexpr std::uint64_t strangers_robot = 667;
inline constexpr double strangers_torque = 99.0;  ///< [Nm]

/// The hash that the programs use for a robot file that ships with the project: "robots/planar_3rrr.yaml".
std::uint32_t shipped_robot(const std::string& name);

/// A program that asks for operation and sends torque commands every millisecond: for 50 ms neutral ones,
/// then `strangers_torque` on each drive, with these headers; `robot_id`: that they are meant for.
OtherProgram stranger(std::uint32_t domain, std::uint32_t robot, std::uint16_t version,
                      std::uint64_t robot_id);

/// A program that sends what others have sent, every millisecond the next command, again and again, and the
/// requests first.
OtherProgram replayer(std::uint32_t domain, const std::vector<flinch_DriveRequest>& requests,
                      const std::vector<flinch_TorqueSample>& commands);

/// A program that sends joint readings as a robot does that speaks this version.
OtherProgram strange_robot(std::uint32_t domain, std::uint32_t robot, std::uint16_t version);

}  // namespace flinch::test
