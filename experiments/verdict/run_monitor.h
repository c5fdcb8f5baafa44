#pragma once

#include <memory>

#include "experiments/verdict/recorded_run.h"
#include "experiments/verdict/verdict.h"

namespace flinch {

/// Measures all that a run shows, sample by sample: afterwards from a recording, or while it goes on. It
/// keeps no samples.
class RunMonitor {
 public:
  /// Of samples as those of `run`.
  RunMonitor(const RecordedRun& run, const ForceLimits& limits);
  ~RunMonitor();

  /// The next sample.
  void see(const RunSample& now);

  /// Of a run that ended with the sample seen last. Its failures are those of the gate alone; judge() finds
  /// the rest.
  Verdict seen() const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace flinch
