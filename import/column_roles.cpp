#include "import/column_roles.h"

#include <algorithm>
#include <array>
#include <optional>
#include <vector>

#include "import/unit_words.h"

namespace flinch {
namespace {

bool is_upper(char letter) { return letter >= 'A' && letter <= 'Z'; }
bool is_letter(char letter) { return is_upper(letter) || (letter >= 'a' && letter <= 'z'); }

/// "motorTorque_phi2 [Nm]" is "motor", "torque", "phi".
std::vector<std::string> words_of(std::string_view name) {
  std::vector<std::string> words;
  std::string word;
  const auto end = [&] {
    if (!word.empty()) words.push_back(word);
    word.clear();
  };
  for (std::size_t i = 0; i < name.size() && name[i] != '[' && name[i] != '('; ++i) {
    if (!is_letter(name[i])) {
      end();
      continue;
    }
    const bool begins = is_upper(name[i]) && i > 0 && is_letter(name[i - 1]) && !is_upper(name[i - 1]);
    if (begins) end();
    word += static_cast<char>(is_upper(name[i]) ? name[i] + 32 : name[i]);
  }
  end();
  return words;
}

struct Keyword {
  std::string_view word;
  ColumnRole role;
};

// The first that a name has decides, so what is more particular stands first.
constexpr std::array keywords = {Keyword{"time", ColumnRole::time},
                                 Keyword{"timestamp", ColumnRole::time},
                                 Keyword{"stamp", ColumnRole::time},
                                 Keyword{"logged", ColumnRole::time},
                                 Keyword{"zeit", ColumnRole::time},
                                 Keyword{"clock", ColumnRole::time},
                                 Keyword{"date", ColumnRole::time},
                                 Keyword{"datum", ColumnRole::time},
                                 Keyword{"truth", ColumnRole::derived},
                                 Keyword{"reference", ColumnRole::derived},
                                 Keyword{"ref", ColumnRole::derived},
                                 Keyword{"desired", ColumnRole::derived},
                                 Keyword{"setpoint", ColumnRole::derived},
                                 Keyword{"soll", ColumnRole::derived},
                                 Keyword{"features", ColumnRole::derived},
                                 Keyword{"tip", ColumnRole::derived},
                                 Keyword{"tcp", ColumnRole::derived},
                                 Keyword{"pose", ColumnRole::derived},
                                 Keyword{"gyro", ColumnRole::angular_velocity},
                                 Keyword{"gyr", ColumnRole::angular_velocity},
                                 Keyword{"gyroscope", ColumnRole::angular_velocity},
                                 Keyword{"acc", ColumnRole::specific_force},
                                 Keyword{"accel", ColumnRole::specific_force},
                                 Keyword{"acceleration", ColumnRole::specific_force},
                                 Keyword{"accelerometer", ColumnRole::specific_force},
                                 Keyword{"current", ColumnRole::current},
                                 Keyword{"cur", ColumnRole::current},
                                 Keyword{"curr", ColumnRole::current},
                                 Keyword{"strom", ColumnRole::current},
                                 Keyword{"iq", ColumnRole::current},
                                 Keyword{"amps", ColumnRole::current},
                                 Keyword{"velocity", ColumnRole::velocity},
                                 Keyword{"vel", ColumnRole::velocity},
                                 Keyword{"speed", ColumnRole::velocity},
                                 Keyword{"dq", ColumnRole::velocity},
                                 Keyword{"qd", ColumnRole::velocity},
                                 Keyword{"qdot", ColumnRole::velocity},
                                 Keyword{"torque", ColumnRole::torque},
                                 Keyword{"trq", ColumnRole::torque},
                                 Keyword{"tau", ColumnRole::torque},
                                 Keyword{"effort", ColumnRole::torque},
                                 Keyword{"force", ColumnRole::force},
                                 Keyword{"kraft", ColumnRole::force},
                                 Keyword{"passive", ColumnRole::passive_position},
                                 Keyword{"qp", ColumnRole::passive_position},
                                 Keyword{"position", ColumnRole::position},
                                 Keyword{"pos", ColumnRole::position},
                                 Keyword{"angle", ColumnRole::position},
                                 Keyword{"winkel", ColumnRole::position},
                                 Keyword{"encoder", ColumnRole::position},
                                 Keyword{"enc", ColumnRole::position},
                                 Keyword{"joint", ColumnRole::position},
                                 Keyword{"joints", ColumnRole::position},
                                 Keyword{"gelenk", ColumnRole::position},
                                 Keyword{"theta", ColumnRole::position},
                                 Keyword{"phi", ColumnRole::position},
                                 Keyword{"psi", ColumnRole::position},
                                 Keyword{"rho", ColumnRole::position},
                                 Keyword{"alpha", ColumnRole::position},
                                 Keyword{"beta", ColumnRole::position},
                                 Keyword{"qa", ColumnRole::position},
                                 Keyword{"q", ColumnRole::position},
                                 Keyword{"p", ColumnRole::passive_position},
                                 Keyword{"i", ColumnRole::current},
                                 Keyword{"ia", ColumnRole::current},
                                 Keyword{"ib", ColumnRole::current},
                                 Keyword{"ic", ColumnRole::current},
                                 Keyword{"fx", ColumnRole::force},
                                 Keyword{"fy", ColumnRole::force},
                                 Keyword{"fz", ColumnRole::force},
                                 Keyword{"mx", ColumnRole::moment},
                                 Keyword{"my", ColumnRole::moment},
                                 Keyword{"mz", ColumnRole::moment},
                                 Keyword{"tx", ColumnRole::moment},
                                 Keyword{"ty", ColumnRole::moment},
                                 Keyword{"tz", ColumnRole::moment},
                                 Keyword{"wx", ColumnRole::angular_velocity},
                                 Keyword{"wy", ColumnRole::angular_velocity},
                                 Keyword{"wz", ColumnRole::angular_velocity},
                                 Keyword{"gx", ColumnRole::angular_velocity},
                                 Keyword{"gy", ColumnRole::angular_velocity},
                                 Keyword{"gz", ColumnRole::angular_velocity},
                                 Keyword{"ax", ColumnRole::specific_force},
                                 Keyword{"ay", ColumnRole::specific_force},
                                 Keyword{"az", ColumnRole::specific_force},
                                 Keyword{"sec", ColumnRole::time},
                                 Keyword{"secs", ColumnRole::time},
                                 Keyword{"nsec", ColumnRole::time},
                                 Keyword{"nanosec", ColumnRole::time},
                                 Keyword{"t", ColumnRole::time}};

/// What a name says that tells nothing by itself, by its unit.
ColumnRole role_of_unit(std::string_view unit) {
  const std::optional<UnitWord> word = unit_word(unit);
  if (!word) return ColumnRole::unknown;
  switch (word->quantity) {
    case UnitWord::Quantity::angle:
      return ColumnRole::position;
    case UnitWord::Quantity::angular_velocity:
    case UnitWord::Quantity::velocity:
      return ColumnRole::velocity;
    case UnitWord::Quantity::acceleration:
      return ColumnRole::specific_force;
    case UnitWord::Quantity::current:
      return ColumnRole::current;
    case UnitWord::Quantity::moment:
      return ColumnRole::torque;
    case UnitWord::Quantity::force:
      return ColumnRole::force;
    case UnitWord::Quantity::time:
      return ColumnRole::time;
    case UnitWord::Quantity::length:
      break;
  }
  return ColumnRole::unknown;
}

int axis_of(const std::vector<std::string>& words) {
  if (words.empty()) return -1;
  const std::string& last = words.back();
  constexpr std::string_view axes = "xyz";
  const bool is_short = last.size() == 1 || last.size() == 2;
  const std::size_t axis = is_short ? axes.find(last.back()) : std::string_view::npos;
  return axis == std::string_view::npos ? -1 : static_cast<int>(axis);
}

}  // namespace

NamedRole role_of(std::string_view name, std::string_view unit) {
  // What a column is called in its group says more than what the group is called.
  if (const std::size_t group = name.rfind('/'); group != std::string_view::npos && group > 0) {
    const NamedRole inside = role_of(name.substr(group + 1), "");
    if (inside.role != ColumnRole::unknown) return inside;
  }
  std::vector<std::string> words = words_of(name);
  // What ends a name as its unit is no word of it.
  if (words.size() > 1 && unit_word(words.back()) && words.back().size() > 1) words.pop_back();
  NamedRole role{ColumnRole::unknown, axis_of(words)};
  for (const Keyword& keyword : keywords) {
    if (role.role == ColumnRole::unknown &&
        std::find(words.begin(), words.end(), keyword.word) != words.end())
      role.role = keyword.role;
  }
  const auto has = [&](std::string_view word) {
    return std::find(words.begin(), words.end(), word) != words.end();
  };
  if (role.role == ColumnRole::unknown) role.role = role_of_unit(unit);
  if (role.role == ColumnRole::position && has("passive")) role.role = ColumnRole::passive_position;
  // "angular_velocity_x" and "omega_y" are of an instrument; so is a torque about an axis beside forces.
  if (role.axis >= 0 && (role.role == ColumnRole::velocity || has("omega")))
    role.role = has("linear") ? ColumnRole::derived : ColumnRole::angular_velocity;
  if (role.axis >= 0 && role.role == ColumnRole::torque) role.role = ColumnRole::moment;
  if (role.axis >= 0 && role.role == ColumnRole::position) role.role = ColumnRole::derived;
  return role;
}

std::string spoken(ColumnRole role) {
  switch (role) {
    case ColumnRole::unknown:
      return "nothing that is known";
    case ColumnRole::time:
      return "time";
    case ColumnRole::position:
      return "positions of drives";
    case ColumnRole::passive_position:
      return "passive joints";
    case ColumnRole::velocity:
      return "velocities";
    case ColumnRole::current:
      return "currents";
    case ColumnRole::torque:
      return "torques of drives";
    case ColumnRole::angular_velocity:
      return "angular velocity of an IMU";
    case ColumnRole::specific_force:
      return "specific force of an IMU";
    case ColumnRole::force:
      return "forces";
    case ColumnRole::moment:
      return "moments";
    case ColumnRole::derived:
      return "what was computed";
  }
  return "";
}

}  // namespace flinch
