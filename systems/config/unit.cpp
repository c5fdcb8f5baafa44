#include "systems/config/unit.h"

#include <algorithm>
#include <array>
#include <numbers>

namespace flinch {
namespace {

constexpr double degree = std::numbers::pi / 180.0;

// The units of one quantity stand together, SI first.
constexpr std::array known_units = {
    KeyUnit{"", unit::none},
    KeyUnit{"m", unit::m},
    KeyUnit{"mm", unit::m, 1.0, 1e3},
    KeyUnit{"cm", unit::m, 1.0, 1e2},
    KeyUnit{"m_per_s", unit::m_per_s},
    KeyUnit{"mm_per_s", unit::m_per_s, 1.0, 1e3},
    KeyUnit{"m_per_s2", unit::m_per_s2},
    KeyUnit{"m_per_s3", unit::m_per_s3},
    KeyUnit{"rad", unit::rad},
    KeyUnit{"deg", unit::rad, degree},
    KeyUnit{"rad_per_s", unit::rad_per_s},
    KeyUnit{"deg_per_s", unit::rad_per_s, degree},
    KeyUnit{"rad_per_s2", unit::rad_per_s2},
    KeyUnit{"deg_per_s2", unit::rad_per_s2, degree},
    KeyUnit{"rad_per_s3", unit::rad_per_s3},
    KeyUnit{"deg_per_s3", unit::rad_per_s3, degree},
    KeyUnit{"s", unit::s},
    KeyUnit{"ms", unit::s, 1.0, 1e3},
    KeyUnit{"us", unit::s, 1.0, 1e6},
    KeyUnit{"per_s", unit::per_s},
    KeyUnit{"per_s2", unit::per_s2},
    KeyUnit{"Hz", unit::Hz},
    KeyUnit{"kHz", unit::Hz, 1e3},
    KeyUnit{"kg", unit::kg},
    KeyUnit{"g", unit::kg, 1.0, 1e3},
    KeyUnit{"kg_m", unit::kg_m},
    KeyUnit{"kg_m2", unit::kg_m2},
    KeyUnit{"kg_cm2", unit::kg_m2, 1.0, 1e4},
    KeyUnit{"N", unit::N},
    KeyUnit{"kN", unit::N, 1e3},
    KeyUnit{"N_per_s", unit::N_per_s},
    KeyUnit{"N_per_m", unit::N_per_m},
    KeyUnit{"N_per_mm", unit::N_per_m, 1e3},
    KeyUnit{"kN_per_m", unit::N_per_m, 1e3},
    KeyUnit{"N2_per_s", unit::N2_per_s},
    KeyUnit{"Ns", unit::Ns},
    KeyUnit{"Ns_per_m", unit::Ns_per_m},
    KeyUnit{"Nm", unit::Nm},
    KeyUnit{"mNm", unit::Nm, 1.0, 1e3},
    KeyUnit{"Nm_per_s", unit::Nm_per_s},
    KeyUnit{"Nm_per_rad", unit::Nm_per_rad},
    KeyUnit{"Nm_per_deg", unit::Nm_per_rad, 1.0, degree},
    KeyUnit{"N2m2_per_s", unit::N2m2_per_s},
    KeyUnit{"Nms", unit::Nms},
    KeyUnit{"Nms_per_rad", unit::Nms_per_rad},
    KeyUnit{"A", unit::A},
    KeyUnit{"mA", unit::A, 1.0, 1e3},
    KeyUnit{"Nm_per_A", unit::Nm_per_A},
    KeyUnit{"N_per_A", unit::N_per_A},
    KeyUnit{"m_per_s2_per_sqrt_Hz", unit::m_per_s2_per_sqrt_Hz},
    KeyUnit{"rad_per_s_per_sqrt_Hz", unit::rad_per_s_per_sqrt_Hz},
    KeyUnit{"deg_per_s_per_sqrt_Hz", unit::rad_per_s_per_sqrt_Hz, degree},
};

}  // namespace

std::span<const KeyUnit> key_units(const Unit& si) {
  const auto same = [&si](const KeyUnit& candidate) { return candidate.si == si; };
  const auto first = std::find_if(known_units.begin(), known_units.end(), same);
  return {first, std::find_if_not(first, known_units.end(), same)};
}

const KeyUnit* find_key_unit(std::string_view key) {
  const auto found = std::find_if(known_units.begin(), known_units.end(),
                                  [key](const KeyUnit& candidate) { return candidate.key == key; });
  return found == known_units.end() ? nullptr : &*found;
}

const KeyUnit* find_key_unit_of(std::string_view symbol) {
  const auto found = std::find_if(known_units.begin(), known_units.end(), [symbol](const KeyUnit& candidate) {
    return candidate.si.symbol == symbol;
  });
  return found == known_units.end() ? nullptr : &*found;
}

std::string key_with_unit(std::string_view name, std::string_view unit_key) {
  std::string key(name);
  if (!unit_key.empty()) key.append("_").append(unit_key);
  return key;
}

std::string possible_keys(std::string_view name, const Unit& si) {
  const std::span<const KeyUnit> units = key_units(si);
  std::string list;
  for (std::size_t i = 0; i < units.size(); ++i) {
    if (i > 0) list += i + 1 < units.size() ? ", " : " or ";
    list += key_with_unit(name, units[i].key);
  }
  return list;
}

}  // namespace flinch
