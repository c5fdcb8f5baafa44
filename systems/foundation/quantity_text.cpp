#include "systems/foundation/quantity_text.h"

#include <numbers>
#include <sstream>

namespace flinch {

std::string quantity_text(double value, const std::string& unit) {
  std::ostringstream text;
  text << value;
  if (!unit.empty()) text << " " << unit;
  if (unit == "rad") text << " (" << value * 180.0 / std::numbers::pi << " deg)";
  return text.str();
}

}  // namespace flinch
