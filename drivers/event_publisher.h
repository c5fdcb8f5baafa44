#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "diagrams/link_status.h"
#include "drivers/dds_bus.h"
#include "systems/framework/context.h"
#include "systems/framework/exchange.h"
#include "systems/framework/tick_timing.h"
#include "systems/signals/contact_detection.h"
#include "systems/signals/gate_status.h"
#include "systems/signals/reaction_state.h"

namespace flinch {

/// Where a controller's events and diagnostics come from; what is not there is told as such.
struct EventSources {
  std::optional<OutputPort<ContactDetection>> detection;
  std::optional<OutputPort<ReactionState>> reaction;
  std::optional<OutputPort<GateStatus>> gate;
  std::optional<InputPort<TickTiming>> timing;  ///< that RealtimeRunner::feed_timing() sets
  std::vector<OutputPort<LinkStatus>> links;    ///< of an ExternalStation
};

struct EventSettings {
  std::uint32_t robot = 0;    ///< robot_hash() of the robot description
  std::uint32_t session = 0;  ///< that the samples name, see DdsStation::session(); 0: one of its own
};

/// Tells on the bus what a running controller detects and does: a contact event for each tick at which a
/// contact begins, reaches a higher level or ends, or the reaction changes; and diagnostics ten times a
/// second. Both are flinch's own topics, see drivers/idl/flinch.idl; each event arrives, in order, at all
/// who listen by then.
///
/// Sending happens on another thread. What is called from the loop neither blocks, allocates nor throws: an
/// event that finds 128 others waiting is lost, which is counted and leaves a gap in the numbers.
class EventPublisher final : public Exchange {
 public:
  /// Throws SetupError.
  EventPublisher(const DdsBus& bus, const Diagram& diagram, const EventSources& sources,
                 const EventSettings& settings);
  /// Sends what is left before.
  ~EventPublisher() override;

  void set_inputs(Context& context) override;
  void take_outputs(const Context& context) override;

  /// How many events were not sent. From any thread.
  std::uint32_t lost() const noexcept;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace flinch
