#include "systems/robot/parameter_findings.h"

#include <cmath>
#include <sstream>

namespace flinch {

void ParameterFindings::positive(const std::string& field, double value, const char* unit) {
  if (!(std::isfinite(value) && value > 0.0)) add(field, value, unit, "it must be positive");
}

void ParameterFindings::not_negative(const std::string& field, double value, const char* unit) {
  if (!(std::isfinite(value) && value >= 0.0)) add(field, value, unit, "it must not be negative");
}

void ParameterFindings::finite(const std::string& field, double value, const char* unit) {
  if (!std::isfinite(value)) add(field, value, unit, "it must be finite");
}

void ParameterFindings::finite(const std::string& field, const Eigen::Ref<const Eigen::VectorXd>& values,
                               const char* unit) {
  for (int i = 0; i < values.size(); ++i) finite(field + "[" + std::to_string(i) + "]", values[i], unit);
}

void ParameterFindings::friction(const std::string& field, const JointFriction& friction) {
  not_negative(field + ".viscous", friction.viscous, "Nm s/rad");
  not_negative(field + ".coulomb", friction.coulomb, "Nm");
}

void ParameterFindings::sliding_friction(const std::string& field, const JointFriction& friction) {
  not_negative(field + ".viscous", friction.viscous, "N s/m");
  not_negative(field + ".coulomb", friction.coulomb, "N");
}

void ParameterFindings::add(const std::string& field, double value, const char* unit,
                            const char* expectation) {
  std::ostringstream sentence;
  sentence << field << " is " << value << ' ' << unit << "; " << expectation;
  sentences_.push_back(sentence.str());
}

}  // namespace flinch
