#include "systems/sensors/first_order_low_pass.h"

#include <numbers>

#include "systems/foundation/findings.h"

namespace flinch {

std::vector<std::string> problems(const LowPassSettings& settings) {
  Findings found;
  found.positive("cutoff_frequency", settings.cutoff_frequency, "Hz");
  return found.take();
}

FirstOrderLowPass::FirstOrderLowPass(const LowPassSettings& settings)
    : w_(2.0 * std::numbers::pi * settings.cutoff_frequency), form_(settings.form) {}

LowPassMemory FirstOrderLowPass::next(const LowPassMemory& memory, const JointVector& mean,
                                      double interval) const noexcept {
  if (!memory.started) return {true, mean, mean};
  const double a = (2.0 - w_ * interval) / (2.0 + w_ * interval);
  if (form_ == LowPassForm::tustin) return {true, mean, a * memory.output + (1.0 - a) * mean};
  return {true, mean, a * memory.output + 0.5 * (1.0 - a) * (mean + memory.mean)};
}

}  // namespace flinch
