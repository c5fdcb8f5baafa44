#pragma once

#include <optional>
#include <string>
#include <vector>

#include "learning/data_set.h"

namespace flinch {

struct Recording;
struct SampleChoice;

/// The samples of one run, and why there are none where there are none.
struct ContactSamples {
  std::vector<DataSample> samples;
  /// "": there are some. Otherwise "nothing touched", "not detected", "detected before anything touched", or
  /// "detected, but" and what was missing: a label, a tick that is asked for, the wrench or the motion.
  std::string left_out;
};

/// What somebody knows of a contact.
struct GivenContact {
  int touched = 0;  ///< the class
  /// When it begins, and when the next one does [s]; by default it is the first that is detected.
  std::optional<double> begin{}, next{};
};

/// The signals of a recording that samples are made of.
std::vector<std::string> sampled_signals(const SampleChoice& choice);

/// The first contact of a recording as samples, `run` and `configuration` still 0, or that which is `given`
/// where the recording does not hold the truth or it is to be overruled. Ticks at which several
/// bodies are touched without being clamped are left out: they have no label. A leg counts as clamped as
/// long as both its links were touched within the last 5 ms. Throws SetupError where signals are missing.
ContactSamples contact_samples(const Recording& recording, const ParallelRobot& robot,
                               const SampleChoice& choice,
                               const std::optional<GivenContact>& given = std::nullopt);

}  // namespace flinch
