#include "drivers/robot_id.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdio>

#include "drivers/wire_header.h"
#include "systems/foundation/setup_error.h"

namespace flinch {
namespace {

constexpr std::size_t id_digits = 16;

std::uint64_t name_half(std::uint64_t id) { return id >> 32; }

bool is_hexadecimal(char letter) {
  return (letter >= '0' && letter <= '9') || (letter >= 'a' && letter <= 'f');
}

bool is_of_a_name(char letter) {
  return (letter >= '0' && letter <= '9') || (letter >= 'a' && letter <= 'z') ||
         (letter >= 'A' && letter <= 'Z') || letter == '_' || letter == '-' || letter == '.';
}

}  // namespace

bool is_robot_id(std::string_view text) noexcept {
  return text.size() == id_digits && std::all_of(text.begin(), text.end(), is_hexadecimal);
}

std::uint64_t draw_robot_id(std::string_view name) {
  const std::uint64_t upper = name.empty() ? draw_session() : robot_hash(name);
  return upper << 32 | draw_session();
}

bool have_one_name(std::uint64_t id, std::uint64_t other) noexcept {
  return name_half(id) == name_half(other);
}

bool is_meant(std::string_view wanted, std::uint64_t id) noexcept {
  if (!is_robot_id(wanted)) return robot_hash(wanted) == name_half(id);
  std::uint64_t number = 0;
  std::from_chars(wanted.data(), wanted.data() + wanted.size(), number, 16);
  return number == id;
}

std::string robot_id_text(std::uint64_t id) {
  std::array<char, id_digits + 1> text{};
  std::snprintf(text.data(), text.size(), "%016llx", static_cast<unsigned long long>(id));
  return text.data();
}

std::vector<std::string> problems_of_robot_name(std::string_view name) {
  std::vector<std::string> found;
  const std::string what = "the name '" + std::string(name) + "' of the robot ";
  if (name.size() > longest_robot_name) found.push_back(what + "is longer than 32 letters");
  if (!std::all_of(name.begin(), name.end(), is_of_a_name)) {
    found.push_back(what + "has other letters than a to z, A to Z, 0 to 9, '_', '-' and '.'");
  }
  if (is_robot_id(name)) found.push_back(what + "looks like an identity, sixteen hexadecimal digits");
  return found;
}

const std::string& checked_robot_name(const std::string& name) {
  throw_if_any(problems_of_robot_name(name));
  return name;
}

std::string text_of(const SeenRobot& robot) {
  const std::string id = robot_id_text(robot.id);
  return robot.name.empty() ? id : robot.name + " (" + id + ")";
}

std::string text_of(const std::vector<SeenRobot>& robots) {
  std::string text;
  for (const SeenRobot& robot : robots) text += (text.empty() ? "" : ", ") + text_of(robot);
  return text;
}

}  // namespace flinch
