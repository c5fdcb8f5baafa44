#pragma once

#include <optional>

#include "experiments/verdict/recorded_run.h"
#include "experiments/verdict/verdict.h"

namespace flinch {

/// Watches how an operator brings the robot back to its nominal motion, sample by sample.
class ReturnMonitor {
 public:
  void see(const RunSample& now);

  /// None: no button `reset` was pressed while something kept the robot from its nominal motion.
  const std::optional<Return>& seen() const { return return_; }

 private:
  void begin(const RunSample& now);
  void go_on(const RunSample& now);

  std::optional<Return> return_;
  // Of the sample before.
  OperatorCommand pressed_{.start = true, .reset = true};  ///< what is down from the start does nothing
  ReactionMode mode_ = ReactionMode::stopped;
  GateStatus gate_;
  bool rested_ = false;  ///< the reference did
};

}  // namespace flinch
