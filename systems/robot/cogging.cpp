#include "systems/robot/cogging.h"

#include <numbers>

#include "systems/foundation/findings.h"

namespace flinch {
namespace {

void find_problems(const CoggingWave& wave, int drives, Findings& found) {
  const auto has_all = [&](const JointVector& values) { return values.size() == drives; };
  found.require(
      has_all(wave.wavelength) && has_all(wave.sine) && has_all(wave.cosine),
      "cogging must have wavelength, sine and cosine of each of the " + std::to_string(drives) + " drives");
  found.require(wave.wavelength.allFinite() && (wave.wavelength.array() > 0.0).all(),
                "cogging has a wavelength that is not positive");
  found.require(wave.sine.allFinite() && wave.cosine.allFinite(), "cogging has a part that is not finite");
}

}  // namespace

JointVector CoggingWave::at(const JointVector& position) const {
  const auto phase = (2.0 * std::numbers::pi * position.array() / wavelength.array()).eval();
  return sine.array() * phase.sin() + cosine.array() * phase.cos();
}

JointVector Cogging::at(const JointVector& position) const {
  JointVector sum = JointVector::Zero(position.size());
  for (const CoggingWave& wave : waves) sum += wave.at(position);
  return sum;
}

std::string cogging_key(int wave) {
  return "cogging" + (wave > 0 ? std::to_string(wave + 1) : std::string()) + "_";
}

std::vector<std::string> problems(const Cogging& cogging, int drives) {
  Findings found;
  for (const CoggingWave& wave : cogging.waves) find_problems(wave, drives, found);
  return found.take();
}

}  // namespace flinch
