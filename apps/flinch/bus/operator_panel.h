#pragma once

#include <atomic>

#include "apps/flinch/bus/live_experiment.h"
#include "drivers/dds_station.h"
#include "systems/framework/context.h"
#include "systems/framework/exchange.h"
#include "systems/framework/triple_buffer.h"

namespace flinch {

/// How a run is at a tick.
struct LiveState {
  Time time{};
  ReactionMode mode = ReactionMode::stopped;
  GateStatus gate;
  double force = 0.0;    ///< of the estimate, a norm [N]
  bool at_rest = false;  ///< see is_at_rest()
  DdsLink link;
};

/// Whether every drive is known to be slower than 0.05 rad/s.
bool is_at_rest(const JointMotion& joints);

/// The operator's part of a run: brings the buttons to the loop, and what the operator wants to see from it.
class OperatorPanel final : public Exchange {
 public:
  OperatorPanel(const LiveExperiment& experiment, const DdsStation& station);

  void set_inputs(Context& context) override;
  void take_outputs(const Context& context) override;

  /// Keeps the stop button down from the next tick on. From any thread.
  void press_stop() noexcept { stop_.store(true, std::memory_order_relaxed); }
  bool stop_pressed() const noexcept { return stop_.load(std::memory_order_relaxed); }

  /// The last state. For one thread at a time.
  const LiveState& last() noexcept {
    states_.take(last_);
    return last_;
  }

 private:
  const DdsStation& station_;
  Slot<OperatorCommand> buttons_;
  Slot<ReactionState> reaction_;
  Slot<GateStatus> gate_;
  Slot<WrenchEstimate> wrench_;
  Slot<JointMotion> joints_;
  std::atomic<bool> stop_ = false;
  TripleBuffer<LiveState> states_;
  LiveState last_;
};

}  // namespace flinch
