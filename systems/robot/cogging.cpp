#include "systems/robot/cogging.h"

#include <numbers>

#include "systems/foundation/findings.h"

namespace flinch {

JointVector Cogging::at(const JointVector& position) const {
  const auto phase = (2.0 * std::numbers::pi * position.array() / wavelength.array()).eval();
  return sine.array() * phase.sin() + cosine.array() * phase.cos();
}

std::vector<std::string> problems(const Cogging& cogging, int drives) {
  Findings found;
  if (cogging.is_none()) return found.take();
  const auto has_all = [&](const JointVector& values) { return values.size() == drives; };
  found.require(
      has_all(cogging.wavelength) && has_all(cogging.sine) && has_all(cogging.cosine),
      "cogging must have wavelength, sine and cosine of each of the " + std::to_string(drives) + " drives");
  found.require(cogging.wavelength.allFinite() && (cogging.wavelength.array() > 0.0).all(),
                "cogging has a wavelength that is not positive");
  found.require(cogging.sine.allFinite() && cogging.cosine.allFinite(),
                "cogging has a part that is not finite");
  return found.take();
}

}  // namespace flinch
