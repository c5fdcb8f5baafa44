#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace flinch {

/// Longest name of a robot, in letters.
inline constexpr std::size_t longest_robot_name = 32;

/// Identity of a robot end on the bus, never 0. The upper half follows from the robot's name, or is drawn at
/// random where it has none; the lower half is drawn at random. So two robots differ, also where somebody has
/// given both the same name, and so do two starts of one.
std::uint64_t draw_robot_id(std::string_view name = {});

/// Whether a text can be what robot_id_text() writes.
bool is_robot_id(std::string_view text) noexcept;

/// Whether a user who writes `wanted` means the robot `id`: its name, or its identity as robot_id_text()
/// writes it.
bool is_meant(std::string_view wanted, std::uint64_t id) noexcept;

/// Whether two identities have their upper halves in common: those of two starts of one robot do, where it
/// has a name.
bool have_one_name(std::uint64_t id, std::uint64_t other) noexcept;

/// Sixteen hexadecimal digits.
std::string robot_id_text(std::uint64_t id);

/// What is wrong with the name of a robot, one sentence each: letters, digits, '_', '-' and '.' make one, but
/// not sixteen hexadecimal digits.
std::vector<std::string> problems_of_robot_name(std::string_view name);
/// `name`, where nothing is wrong with it. Throws SetupError.
const std::string& checked_robot_name(const std::string& name);

/// A robot that was seen on the bus.
struct SeenRobot {
  std::uint64_t id = 0;
  std::string name;  ///< empty where it has none, or has not told it yet
};

/// "arm_1 (0123456789abcdef)", or the identity alone.
std::string text_of(const SeenRobot& robot);

/// The same of several, with commas between.
std::string text_of(const std::vector<SeenRobot>& robots);

}  // namespace flinch
