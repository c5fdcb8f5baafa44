#include "drivers/event_publisher.h"

#include <drivers/idl/flinch.h>

#include <algorithm>
#include <atomic>

#include "drivers/optional_slot.h"
#include "drivers/sample_sender.h"
#include "drivers/sending_thread.h"
#include "drivers/tick_clock.h"
#include "drivers/wire_conversion.h"
#include "systems/framework/bounded_queue.h"

namespace flinch {
namespace {

constexpr Time between_diagnostics = 100ms;

/// What makes one event differ from another.
struct Situation {
  ContactLevel level = ContactLevel::none;
  Time detected{};
  ReactionMode mode = ReactionMode::stopped;

  bool operator==(const Situation&) const = default;
};

SenderIdentity identity(const EventSettings& settings) {
  return {settings.session == 0 ? draw_session() : settings.session, settings.robot};
}

std::vector<Slot<LinkStatus>> slots(const Diagram& diagram,
                                    const std::vector<OutputPort<LinkStatus>>& ports) {
  std::vector<Slot<LinkStatus>> slots;
  for (const OutputPort<LinkStatus>& port : ports) slots.push_back(diagram.slot(port));
  return slots;
}

}  // namespace

class EventPublisher::Implementation {
 public:
  Implementation(const DdsBus& bus, const Diagram& diagram, const EventSources& sources,
                 const EventSettings& settings)
      : sender_(identity(settings)),
        clock_(diagram.tick()),
        ticks_between_diagnostics_(
            static_cast<std::uint32_t>(std::max<std::int64_t>(1, between_diagnostics / diagram.tick()))),
        detection_(diagram, sources.detection),
        reaction_(diagram, sources.reaction),
        gate_(diagram, sources.gate),
        timing_(diagram, sources.timing),
        links_(slots(diagram, sources.links)),
        event_writer_(bus, contact_event_topic),
        diagnostics_sender_(bus, diagnostics_topic, sender_) {
    thread_.emplace([this] { send(); }, 0);
  }

  void set_inputs(Context& context) noexcept { clock_.start_tick(context.time()); }

  void take_outputs(const Context& context) noexcept {
    const Time now = clock_.to_monotonic(context.time());
    const bool eventful = look_for_event(context, now);
    count_tick(context);
    const bool due = diagnostics_.ticks % ticks_between_diagnostics_ == 0;
    if (due) leave_diagnostics(context, now);
    if (eventful || due) thread_->wake();
  }

  std::uint32_t lost() const noexcept { return lost_.load(std::memory_order_relaxed); }

 private:
  bool look_for_event(const Context& context, Time now) noexcept {
    ContactDetection detection;
    ReactionState reaction;
    detection_.copy(context, detection);
    reaction_.copy(context, reaction);
    const Situation situation{detection.level, detection.detected, reaction.mode};
    if (situation == told_) return false;
    told_ = situation;
    flinch_ContactEvent event;
    to_wire(detection, reaction, now, event);
    event.header.number = ++event_number_;
    if (!events_.push(event)) count_loss();
    return true;
  }

  void count_tick(const Context& context) noexcept {
    ++diagnostics_.ticks;
    TickTiming timing;
    timing_.copy(context, timing);
    if (!timing.valid) return;
    diagnostics_.lost_periods += static_cast<std::uint32_t>(timing.lost_periods);
    if (timing.previous.valid && timing.previous.overran) ++diagnostics_.overruns;
  }

  void leave_diagnostics(const Context& context, Time now) noexcept {
    GateStatus gate;
    gate_.copy(context, gate);
    diagnostics_.gate_phase = static_cast<std::uint8_t>(gate.phase);
    diagnostics_.gate_fault = static_cast<std::uint8_t>(gate.fault);
    diagnostics_.gate_faults = gate.faults;
    diagnostics_.skipped = 0;
    diagnostics_.refused = 0;
    for (const Slot<LinkStatus> link : links_) {
      diagnostics_.skipped += context[link].skipped;
      diagnostics_.refused += context[link].refused;
    }
    diagnostics_.events_lost = lost();
    diagnostics_.header.acquired_ns = now.count();
    diagnostics_.header.flags = what_is_known();
    diagnostics_sender_.leave(diagnostics_);
  }

  std::uint8_t what_is_known() const noexcept {
    std::uint8_t flags = 0;
    if (gate_.exists()) flags |= flag_valid;
    if (timing_.exists()) flags |= flag_timing_known;
    if (!links_.empty()) flags |= flag_links_known;
    return flags;
  }

  void count_loss() noexcept { lost_.fetch_add(1, std::memory_order_relaxed); }

  /// On the sending thread.
  void send() noexcept {
    flinch_ContactEvent event;
    while (events_.pop(event)) {
      stamp(event.header, sender_, event.header.number);
      if (!event_writer_.write(&event)) count_loss();
    }
    diagnostics_sender_.send();
  }

  SenderIdentity sender_;
  TickClock clock_;
  std::uint32_t ticks_between_diagnostics_;
  OptionalSlot<ContactDetection> detection_;
  OptionalSlot<ReactionState> reaction_;
  OptionalSlot<GateStatus> gate_;
  OptionalSlot<TickTiming> timing_;
  std::vector<Slot<LinkStatus>> links_;

  Situation told_;
  std::uint32_t event_number_ = 0;
  flinch_Diagnostics diagnostics_{};
  std::atomic<std::uint32_t> lost_ = 0;
  BoundedQueue<flinch_ContactEvent, 128> events_;

  DdsWriter event_writer_;
  SampleSender<flinch_Diagnostics> diagnostics_sender_;
  std::optional<SendingThread> thread_;  // last: ends before what it sends with
};

EventPublisher::EventPublisher(const DdsBus& bus, const Diagram& diagram, const EventSources& sources,
                               const EventSettings& settings)
    : implementation_(std::make_unique<Implementation>(bus, diagram, sources, settings)) {}

EventPublisher::~EventPublisher() = default;

void EventPublisher::set_inputs(Context& context) { implementation_->set_inputs(context); }
void EventPublisher::take_outputs(const Context& context) { implementation_->take_outputs(context); }
std::uint32_t EventPublisher::lost() const noexcept { return implementation_->lost(); }

}  // namespace flinch
