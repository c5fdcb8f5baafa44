#pragma once

#include <atomic>
#include <cstdint>

#include "experiments/bus/operator_order.h"
#include "experiments/live/live_experiment.h"
#include "systems/framework/bounded_queue.h"
#include "systems/framework/context.h"
#include "systems/motion/pose_motion.h"

namespace flinch {

struct ContactControlSettings;

/// Why an order was not followed.
enum class Refusal : std::uint8_t {
  none,
  moves,           ///< reset: the robot moves
  not_nominal,     ///< start, target: neither nominal nor, for a target, recovering
  before_arrival,  ///< start: the reference moves
  too_fast,        ///< target: the reference is faster than the way to a target would be
  out_of_reach,    ///< step: beyond the reach of the legs
  overtaken,       ///< waited when a stop was ordered
};

/// Refusals so far, and the last of them.
struct Refusals {
  std::uint32_t count = 0;
  Refusal last = Refusal::none;
};

/// What is wrong with an order of this sort, as a sentence.
const char* sentence(Refusal refusal) noexcept;

/// Hands an operator's orders to the loop, one a tick with a tick between them in which all buttons are up.
/// - A stop takes effect at the next tick, whatever waits, which is refused; its button stays down until a
///   reset, so that a gate that has not opened yet does not open.
/// - A reset is refused while the robot is known to move, for the gate would not heed it; so is a start or
///   target that would have no effect. None is kept.
class OperatorCommandQueue {
 public:
  OperatorCommandQueue(const LiveExperiment& experiment, const ContactControlSettings& control);

  /// Gives an order. Of one thread, another than the loop's. False where too many wait; never of stop and
  /// end.
  bool give(const OperatorOrder& order) noexcept;

  /// What follows is of the loop's thread. Sets the target of this tick, and tells the buttons.
  OperatorCommand follow(Context& context);
  /// Sees what became of it.
  void see(const Context& context);
  bool end_is_ordered() const noexcept { return end_.load(std::memory_order_relaxed); }
  /// Whether this tick has a reset.
  bool resets() const noexcept { return resets_; }
  const Refusals& refusals() const noexcept { return refusals_; }

 private:
  void refuse(Refusal why) noexcept { refusals_ = {refusals_.count + 1, why}; }
  Refusal objection(const OperatorOrder& order) const;
  /// From now on, and nothing that waits.
  void stop() noexcept;
  /// What this tick follows; nothing in a tick in which all buttons are up.
  OperatorOrder next();

  Slot<TargetCommand> target_;
  Slot<JointMotion> joints_;
  Slot<ReactionState> reaction_;
  Slot<PlatformReference> reference_;
  double rest_speed_;
  PoseLimits approach_, recovery_;
  int translations_;

  BoundedQueue<OperatorOrder, 16> orders_;
  std::atomic<bool> stop_ = false, end_ = false;

  // As of the tick before.
  bool moves_ = false;
  ReactionMode mode_ = ReactionMode::stopped;
  PlatformReference present_;

  bool is_stopped_ = false;     ///< the stop button is down
  bool reset_is_next_ = false;  ///< it was let up for that
  bool follows_ = false;        ///< an order
  bool resets_ = false;
  bool steps_ = false;
  Refusals refusals_;
};

}  // namespace flinch
