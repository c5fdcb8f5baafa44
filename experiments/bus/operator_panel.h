#pragma once

#include "drivers/dds_station.h"
#include "experiments/bus/interrupt_count.h"
#include "experiments/bus/operator_order.h"
#include "experiments/live/live_experiment.h"
#include "systems/framework/bounded_queue.h"
#include "systems/framework/context.h"
#include "systems/framework/exchange.h"
#include "systems/framework/triple_buffer.h"

namespace flinch {

/// How a run is at a tick.
struct LiveState {
  Time time{};
  ReactionMode mode = ReactionMode::stopped;
  GateStatus gate;
  double force = 0.0;  ///< of the estimate, a norm [N]
  DdsLink link;
};

/// The operator's part of a run: brings the buttons to the loop, and what the operator wants to see from it.
class OperatorPanel final : public Exchange {
 public:
  OperatorPanel(const LiveExperiment& experiment, const DdsStation& station, InterruptCount interrupts);

  void set_inputs(Context& context) override;
  void take_outputs(const Context& context) override;

  /// The stop button is down from the start until it is released, and again once it is pressed or somebody
  /// has interrupted the program. Of the loop's thread.
  void release_stop() noexcept { stop_ = false; }
  void press_stop() noexcept { stop_ = true; }

  /// Gives an order, to be followed at the next tick that has none; of one other thread. False where too many
  /// wait.
  bool give(const OperatorOrder& order) noexcept { return orders_.push(order); }
  /// Whether the end was ordered. Of the loop's thread.
  bool end_is_ordered() const noexcept { return end_is_ordered_; }
  /// Whether this tick has the order to reset. Likewise.
  bool resets() const noexcept { return resets_; }

  /// The last state. For one thread at a time.
  const LiveState& last() noexcept {
    states_.take(last_);
    return last_;
  }

 private:
  const DdsStation& station_;
  InterruptCount interrupts_;
  Slot<OperatorCommand> buttons_;
  Slot<TargetCommand> target_;
  Slot<ReactionState> reaction_;
  Slot<GateStatus> gate_;
  Slot<WrenchEstimate> wrench_;
  int translations_;
  bool stop_ = true;
  BoundedQueue<OperatorOrder, 16> orders_;
  bool follows_ = false;  ///< an order, at the last tick; then all buttons are up for one
  bool resets_ = false;
  bool end_is_ordered_ = false;
  TripleBuffer<LiveState> states_;
  LiveState last_;
};

}  // namespace flinch
