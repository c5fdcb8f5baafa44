#include "import/unit_words.h"

#include <algorithm>
#include <array>
#include <numbers>

#include "import/number_text.h"

namespace flinch {
namespace {

using Quantity = UnitWord::Quantity;

constexpr double degree = std::numbers::pi / 180.0;
constexpr double turn = 2.0 * std::numbers::pi;
constexpr double standard_gravity = 9.80665;

// Units of a quantity stand together, SI first.
constexpr std::array known = {UnitWord{"rad", Quantity::angle, 1.0},
                              UnitWord{"radian", Quantity::angle, 1.0},
                              UnitWord{"radians", Quantity::angle, 1.0},
                              UnitWord{"mrad", Quantity::angle, 1e-3},
                              UnitWord{"deg", Quantity::angle, degree},
                              UnitWord{"degree", Quantity::angle, degree},
                              UnitWord{"degrees", Quantity::angle, degree},
                              UnitWord{"grad", Quantity::angle, degree},  // German; a gon is none of robots
                              UnitWord{"\xC2\xB0", Quantity::angle, degree},
                              UnitWord{"rev", Quantity::angle, turn},
                              UnitWord{"turn", Quantity::angle, turn},
                              UnitWord{"turns", Quantity::angle, turn},
                              UnitWord{"m", Quantity::length, 1.0},
                              UnitWord{"mm", Quantity::length, 1e-3},
                              UnitWord{"cm", Quantity::length, 1e-2},
                              UnitWord{"um", Quantity::length, 1e-6},
                              UnitWord{"rad/s", Quantity::angular_velocity, 1.0},
                              UnitWord{"rad_per_s", Quantity::angular_velocity, 1.0},
                              UnitWord{"rads", Quantity::angular_velocity, 1.0},
                              UnitWord{"deg/s", Quantity::angular_velocity, degree},
                              UnitWord{"deg_per_s", Quantity::angular_velocity, degree},
                              UnitWord{"dps", Quantity::angular_velocity, degree},
                              UnitWord{"\xC2\xB0/s", Quantity::angular_velocity, degree},
                              UnitWord{"rpm", Quantity::angular_velocity, turn / 60.0},
                              UnitWord{"1/min", Quantity::angular_velocity, turn / 60.0},
                              UnitWord{"m/s", Quantity::velocity, 1.0},
                              UnitWord{"mm/s", Quantity::velocity, 1e-3},
                              UnitWord{"m/s^2", Quantity::acceleration, 1.0},
                              UnitWord{"m/s2", Quantity::acceleration, 1.0},
                              UnitWord{"m/s/s", Quantity::acceleration, 1.0},
                              UnitWord{"m_per_s2", Quantity::acceleration, 1.0},
                              UnitWord{"m/s\xC2\xB2", Quantity::acceleration, 1.0},
                              UnitWord{"g", Quantity::acceleration, standard_gravity},
                              UnitWord{"mg", Quantity::acceleration, 1e-3 * standard_gravity},
                              UnitWord{"A", Quantity::current, 1.0},
                              UnitWord{"amp", Quantity::current, 1.0},
                              UnitWord{"ampere", Quantity::current, 1.0},
                              UnitWord{"mA", Quantity::current, 1e-3},
                              UnitWord{"N", Quantity::force, 1.0},
                              UnitWord{"kN", Quantity::force, 1e3},
                              UnitWord{"mN", Quantity::force, 1e-3},
                              UnitWord{"kgf", Quantity::force, standard_gravity},
                              UnitWord{"Nm", Quantity::moment, 1.0},
                              UnitWord{"N m", Quantity::moment, 1.0},
                              UnitWord{"N*m", Quantity::moment, 1.0},
                              UnitWord{"N.m", Quantity::moment, 1.0},
                              UnitWord{"N-m", Quantity::moment, 1.0},
                              UnitWord{"N\xC2\xB7m", Quantity::moment, 1.0},
                              UnitWord{"mNm", Quantity::moment, 1e-3},
                              UnitWord{"Ncm", Quantity::moment, 1e-2},
                              UnitWord{"s", Quantity::time, 1.0},
                              UnitWord{"sec", Quantity::time, 1.0},
                              UnitWord{"secs", Quantity::time, 1.0},
                              UnitWord{"second", Quantity::time, 1.0},
                              UnitWord{"seconds", Quantity::time, 1.0},
                              UnitWord{"ms", Quantity::time, 1e-3},
                              UnitWord{"msec", Quantity::time, 1e-3},
                              UnitWord{"millis", Quantity::time, 1e-3},
                              UnitWord{"us", Quantity::time, 1e-6},
                              UnitWord{"usec", Quantity::time, 1e-6},
                              UnitWord{"micros", Quantity::time, 1e-6},
                              UnitWord{"\xC2\xB5s", Quantity::time, 1e-6},
                              UnitWord{"\xCE\xBCs", Quantity::time, 1e-6},
                              UnitWord{"ns", Quantity::time, 1e-9},
                              UnitWord{"nsec", Quantity::time, 1e-9},
                              UnitWord{"nanos", Quantity::time, 1e-9}};

constexpr std::array others = {"V",
                               "mV",
                               "W",
                               "%",
                               "\xE2\x80\xB0",
                               "permille",
                               "counts",
                               "count",
                               "C",
                               "K",
                               "\xC2\xB0"
                               "C",
                               "Hz",
                               "ticks",
                               "cnt",
                               "inc",
                               "1",
                               "-",
                               "bar",
                               "Pa",
                               "kg",
                               "bool",
                               "rad/s^2",
                               "rad/s2",
                               "deg/s^2",
                               "n/a",
                               "date",
                               "int",
                               "hh:mm:ss"};

std::string_view without_brackets(std::string_view word) {
  word = trimmed(word);
  constexpr std::string_view open = "[(<{", close = "])>}";
  while (word.size() >= 2 && open.find(word.front()) != std::string_view::npos &&
         close.find(word.back()) != std::string_view::npos)
    word = trimmed(word.substr(1, word.size() - 2));
  return word;
}

bool is_same(std::string_view a, std::string_view b) {
  if (a == b) return true;
  // "MS" and "Sec", but a milliampere is no megaampere and a newton no nano.
  if (a.size() < 2) return false;
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](char x, char y) {
    return (x >= 'A' && x <= 'Z' ? x + 32 : x) == (y >= 'A' && y <= 'Z' ? y + 32 : y);
  });
}

}  // namespace

std::optional<UnitWord> unit_word(std::string_view word) {
  word = without_brackets(word);
  for (const UnitWord& each : known) {
    if (each.word == word) return each;
  }
  for (const UnitWord& each : known) {
    if (is_same(each.word, word)) return each;
  }
  return std::nullopt;
}

bool is_unit_word(std::string_view word) {
  const std::string_view inner = without_brackets(word);
  return unit_word(inner) ||
         std::any_of(others.begin(), others.end(), [&](const char* each) { return is_same(each, inner); });
}

std::string unit_in_name(std::string_view name) {
  name = trimmed(name);
  if (name.empty()) return "";
  const std::size_t number_mark = name.rfind('#');
  if (number_mark != std::string_view::npos && number_mark + 1 < name.size() &&
      name[number_mark + 1] >= '0' && name[number_mark + 1] <= '9')
    name = trimmed(name.substr(0, number_mark));
  for (const auto& [open, close] : {std::pair('[', ']'), std::pair('(', ')')}) {
    const std::size_t begin = name.rfind(open), end = name.rfind(close);
    if (begin != std::string_view::npos && end != std::string_view::npos && begin < end && begin > 0 &&
        is_unit_word(name.substr(begin + 1, end - begin - 1)))
      return std::string(trimmed(name.substr(begin + 1, end - begin - 1)));
  }
  // The longest end of the name that is a unit: "w_deg_per_s", not "s".
  for (std::size_t at = 1; at + 1 < name.size(); ++at) {
    if (name[at] != '_' && name[at] != ',' && name[at] != '/' && name[at] != ' ') continue;
    const std::string_view end = trimmed(name.substr(at + 1));
    if (unit_word(end) && (end.size() > 1 || name[at] != '_' || end == "s" || end == "A" || end == "N"))
      return std::string(end);
  }
  return "";
}

std::string unit_words(UnitWord::Quantity quantity) {
  std::string words;
  for (const UnitWord& each : known) {
    if (each.quantity == quantity) words += (words.empty() ? "" : ", ") + std::string(each.word);
  }
  return words;
}

}  // namespace flinch
