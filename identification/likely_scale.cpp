#include "identification/likely_scale.h"

#include <fmt/core.h>

#include <array>
#include <cmath>

namespace flinch {
namespace {

constexpr double near = 0.06;  // of a factor

constexpr std::array currents = {ScaleCause{1e3, "they are in mA and were taken for A"},
                                 ScaleCause{1e-3, "they are in A and were taken for mA"},
                                 ScaleCause{1.41421356, "they are peak values and not effective ones"},
                                 ScaleCause{0.70710678, "they are effective values and not peak ones"}};
constexpr std::array instruments = {ScaleCause{0.101971621, "they are in kgf and were taken for N"},
                                    ScaleCause{0.224808943, "they are in lbf and were taken for N"},
                                    ScaleCause{9.80665, "they are in N and were taken for kgf"}};
constexpr std::array gyroscopes = {ScaleCause{57.2957795, "it is in deg/s and was taken for rad/s"},
                                   ScaleCause{0.0174532925, "it is in rad/s and was taken for deg/s"},
                                   ScaleCause{9.54929659, "it is in rpm and was taken for rad/s"},
                                   ScaleCause{1e3, "it is in mrad/s and was taken for rad/s"}};
constexpr std::array accelerometers = {ScaleCause{0.101971621, "it is in g and was taken for m/s^2"},
                                       ScaleCause{101.971621, "it is in mg and was taken for m/s^2"},
                                       ScaleCause{9.80665, "it is in m/s^2 and was taken for g"},
                                       ScaleCause{1e3, "it is in mm/s^2 and was taken for m/s^2"},
                                       ScaleCause{0.00980665, "it is in m/s^2 and was taken for mg"}};

}  // namespace

std::span<const ScaleCause> causes_of_currents() { return currents; }
std::span<const ScaleCause> causes_of_instruments() { return instruments; }
std::span<const ScaleCause> causes_of_gyroscopes() { return gyroscopes; }
std::span<const ScaleCause> causes_of_accelerometers() { return accelerometers; }

std::optional<std::string> likely_cause(double factor, std::span<const ScaleCause> causes) {
  for (const ScaleCause& each : causes) {
    if (std::abs(factor / each.factor - 1.0) < near) return each.cause;
  }
  return std::nullopt;
}

std::string factor_text(double factor) { return fmt::format("{:.3g} times", factor); }

}  // namespace flinch
