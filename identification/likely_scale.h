#pragma once

#include <optional>
#include <span>
#include <string>

namespace flinch {

/// A factor by which readings are too large, and what makes it.
struct ScaleCause {
  double factor = 1.0;
  const char* cause = "";
};

/// Of currents, with [A] for what is right.
std::span<const ScaleCause> causes_of_currents();
/// Of the forces and moments of an instrument [N, Nm].
std::span<const ScaleCause> causes_of_instruments();
/// Of rates of turn [rad/s].
std::span<const ScaleCause> causes_of_gyroscopes();
/// Of specific forces [m/s^2].
std::span<const ScaleCause> causes_of_accelerometers();

/// The cause whose factor is within 6 % of `factor`; nothing where there is none.
std::optional<std::string> likely_cause(double factor, std::span<const ScaleCause> causes);

/// "57.3 times": how a factor is said.
std::string factor_text(double factor);

}  // namespace flinch
