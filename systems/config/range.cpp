#include "systems/config/range.h"

#include <cmath>
#include <sstream>

namespace flinch {

bool Range::contains(double value) const {
  if (!std::isfinite(value)) return false;
  const bool above = low_included ? value >= low : value > low;
  const bool below = high_included ? value <= high : value < high;
  return above && below;
}

std::string Range::requirement(const KeyUnit& written) const {
  const bool bounded_below = std::isfinite(low);
  const bool bounded_above = std::isfinite(high);
  if (!bounded_below && !bounded_above) return "be a finite number";
  if (low == 0.0 && !bounded_above) return low_included ? "not be negative" : "be positive";

  std::ostringstream text;
  if (bounded_below && bounded_above && low_included && high_included) {
    text << "lie between " << written.from_si(low) << " and " << written.from_si(high);
    return text.str();
  }
  text << "be ";
  if (bounded_below) text << (low_included ? "at least " : "greater than ") << written.from_si(low);
  if (bounded_below && bounded_above) text << " and ";
  if (bounded_above) text << (high_included ? "at most " : "less than ") << written.from_si(high);
  return text.str();
}

}  // namespace flinch
