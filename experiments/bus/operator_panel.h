#pragma once

#include "drivers/dds_station.h"
#include "experiments/bus/interrupt_count.h"
#include "experiments/bus/operator_command_queue.h"
#include "experiments/live/live_experiment.h"
#include "systems/framework/context.h"
#include "systems/framework/exchange.h"
#include "systems/framework/triple_buffer.h"

namespace flinch {

/// How a run is at a tick.
struct LiveState {
  Time time{};
  ReactionMode mode = ReactionMode::stopped;
  GateStatus gate;
  double force = 0.0;          ///< of the estimate, a norm [N]
  CheckMask askable = 0;       ///< of sensors and drives at any tick since the stop button was released
  bool checks_drives = false;  ///< before the first motion
  DdsLink link;
  Refusals refusals;  ///< of an operator's orders
};

/// The operator's part of a run: brings the buttons to the loop, and what the operator wants to see from it.
class OperatorPanel final : public Exchange {
 public:
  OperatorPanel(const LiveExperiment& experiment, const ContactControlSettings& control,
                const DdsStation& station, InterruptCount interrupts);

  void set_inputs(Context& context) override;
  void take_outputs(const Context& context) override;

  /// The stop button is down from the start until it is released, and again once it is pressed or somebody
  /// has interrupted the program. Of the loop's thread.
  void release_stop() noexcept {
    stop_ = false;
    askable_ = 0;
  }
  void press_stop() noexcept { stop_ = true; }

  OperatorCommandQueue& orders() noexcept { return orders_; }

  /// The last state. For one thread at a time.
  const LiveState& last() noexcept {
    states_.take(last_);
    return last_;
  }

 private:
  const DdsStation& station_;
  InterruptCount interrupts_;
  Slot<OperatorCommand> buttons_;
  Slot<ReactionState> reaction_;
  Slot<GateStatus> gate_;
  Slot<WrenchEstimate> wrench_;
  Slot<Plausibility> plausibility_;
  int translations_;
  bool checks_drives_;
  bool stop_ = true;
  CheckMask askable_ = 0;
  OperatorCommandQueue orders_;
  TripleBuffer<LiveState> states_;
  LiveState last_;
};

}  // namespace flinch
