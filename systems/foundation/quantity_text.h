#pragma once

#include <string>

namespace flinch {

/// A value with its unit, "0.3 m". An angle in rad is told in degrees besides, as files may have it:
/// "0.5 rad (28.6479 deg)".
std::string quantity_text(double value, const std::string& unit);

}  // namespace flinch
