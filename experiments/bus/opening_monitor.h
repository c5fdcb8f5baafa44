#pragma once

#include <string>

#include "systems/framework/time.h"
#include "systems/signals/gate_status.h"

namespace flinch {

/// Whether a torque gate opens at all at the begin of a run.
class OpeningMonitor {
 public:
  static constexpr Time longest = 2s;         ///< that it may take
  static constexpr Time until_settled = 10s;  ///< where nothing but the observer's settling keeps it closed

  /// Looks at the gate at the time `now` of the run, 0 at its begin. Whether it has not opened although it
  /// should have.
  bool sees_it_closed(const GateStatus& gate, Time now) noexcept;
  /// Whether it has been open.
  bool has_opened() const noexcept { return has_opened_; }
  /// Why it has not opened, as a sentence.
  std::string sentence() const;

 private:
  bool has_opened_ = false;
  Time waited_{};
  GateFault cause_ = GateFault::none;
};

}  // namespace flinch
