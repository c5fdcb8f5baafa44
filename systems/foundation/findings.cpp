#include "systems/foundation/findings.h"

#include <cmath>
#include <sstream>

#include "systems/foundation/quantity_text.h"

namespace flinch {

void Findings::positive(const std::string& field, double value, const char* unit) {
  if (!(std::isfinite(value) && value > 0.0)) add(field, value, unit, "must be positive");
}

void Findings::not_negative(const std::string& field, double value, const char* unit) {
  if (!(std::isfinite(value) && value >= 0.0)) add(field, value, unit, "must not be negative");
}

void Findings::at_most(double limit, const std::string& field, double value, const char* unit) {
  std::ostringstream most;
  most << "must be at most " << limit;
  if (!(std::isfinite(value) && value <= limit)) add(field, value, unit, most.str());
}

void Findings::finite(const std::string& field, double value, const char* unit) {
  if (!std::isfinite(value)) add(field, value, unit, "must be finite");
}

void Findings::add(const std::string& field, double value, const char* unit, const std::string& expectation) {
  add(field + " is " + quantity_text(value, unit) + "; it " + expectation);
}

void Findings::add_all(std::vector<std::string> of_part) {
  for (std::string& sentence : of_part) sentences_.push_back(std::move(sentence));
}

}  // namespace flinch
