#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace flinch {

/// SI unit of a quantity: how the key of a value ends, and how people write it.
struct Unit {
  std::string_view key;     ///< "N_per_m": the key of a stiffness ends in _N_per_m. Empty: no unit.
  std::string_view symbol;  ///< "N/m"

  friend bool operator==(const Unit&, const Unit&) = default;
};

/// The quantities that a file may hold. Values arrive in these units, whichever a file is written in.
namespace unit {
inline constexpr Unit none{"", ""};
inline constexpr Unit m{"m", "m"};
inline constexpr Unit m_per_s{"m_per_s", "m/s"};
inline constexpr Unit m_per_s2{"m_per_s2", "m/s^2"};
inline constexpr Unit m_per_s3{"m_per_s3", "m/s^3"};
inline constexpr Unit rad{"rad", "rad"};
inline constexpr Unit rad_per_s{"rad_per_s", "rad/s"};
inline constexpr Unit rad_per_s2{"rad_per_s2", "rad/s^2"};
inline constexpr Unit rad_per_s3{"rad_per_s3", "rad/s^3"};
inline constexpr Unit s{"s", "s"};
inline constexpr Unit per_s{"per_s", "1/s"};
inline constexpr Unit per_s2{"per_s2", "1/s^2"};
inline constexpr Unit Hz{"Hz", "Hz"};
inline constexpr Unit kg{"kg", "kg"};
inline constexpr Unit kg_m{"kg_m", "kg m"};
inline constexpr Unit kg_m2{"kg_m2", "kg m^2"};
inline constexpr Unit N{"N", "N"};
inline constexpr Unit N_per_s{"N_per_s", "N/s"};
inline constexpr Unit N_per_m{"N_per_m", "N/m"};
inline constexpr Unit N2_per_s{"N2_per_s", "N^2/s"};
inline constexpr Unit Ns{"Ns", "N s"};
inline constexpr Unit Ns_per_m{"Ns_per_m", "N s/m"};
inline constexpr Unit Nm{"Nm", "Nm"};
inline constexpr Unit Nm_per_s{"Nm_per_s", "Nm/s"};
inline constexpr Unit Nm_per_rad{"Nm_per_rad", "Nm/rad"};
inline constexpr Unit N2m2_per_s{"N2m2_per_s", "N^2 m^2/s"};
inline constexpr Unit Nms{"Nms", "Nm s"};
inline constexpr Unit Nms_per_rad{"Nms_per_rad", "Nm s/rad"};
inline constexpr Unit A{"A", "A"};
inline constexpr Unit Nm_per_A{"Nm_per_A", "Nm/A"};
inline constexpr Unit N_per_A{"N_per_A", "N/A"};
inline constexpr Unit m_per_s2_per_sqrt_Hz{"m_per_s2_per_sqrt_Hz", "m/s^2/sqrt(Hz)"};
inline constexpr Unit rad_per_s_per_sqrt_Hz{"rad_per_s_per_sqrt_Hz", "rad/s/sqrt(Hz)"};
}  // namespace unit

/// A unit in which the value of a key may be written: itself SI, or a multiple of it.
struct KeyUnit {
  std::string_view key;  ///< "mm"
  Unit si;
  double multiply = 1.0;
  double divide = 1.0;

  /// Divides by 1000 rather than to multiply by 0.001, so that 97 mm are the same bits as 0.097 m.
  double to_si(double value) const { return value * multiply / divide; }
  double from_si(double value) const { return value * divide / multiply; }
};

/// The units in which a quantity may be written, SI first.
std::span<const KeyUnit> key_units(const Unit& si);

/// The unit that a key may end in, or null if there is none called so.
const KeyUnit* find_key_unit(std::string_view key);

/// The SI unit that people write as `symbol`, or null if there is none.
const KeyUnit* find_key_unit_of(std::string_view symbol);

/// The key of a value: its name with its unit, such as link1_length_mm.
std::string key_with_unit(std::string_view name, std::string_view unit_key);

/// "link1_length_m, link1_length_mm or link1_length_cm": the keys under which a value may be given.
std::string possible_keys(std::string_view name, const Unit& si);

}  // namespace flinch
