#include "drivers/event_publisher.h"

#include <dds/dds.h>
#include <drivers/idl/flinch.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <unistd.h>

#include <thread>

#include "drivers/topics.h"
#include "drivers/wire_header.h"
#include "systems/foundation/setup_error.h"
#include "systems/framework/diagram_builder.h"
#include "systems/framework/monotonic_clock.h"
#include "tests/support/allocations.h"
#include "tests/support/free_domain.h"
#include "tests/support/other_program.h"

namespace flinch {
namespace {

/// Lets an input of the diagram be seen as an output.
template <PortValue T>
class Relay final : public System {
 public:
  InputPort<T> in = System::input<T>("in");
  OutputPort<T> out = System::output<&Relay::pass>("out", in);

 private:
  T pass(const T& value) const { return value; }
};

/// A controller whose every output the test sets.
class ScriptedController {
 public:
  ScriptedController() : diagram_(build()), context_(diagram_->make_context()) {}

  ContactDetection& detection() { return context_[diagram_->slot(detection_)]; }
  ReactionState& reaction() { return context_[diagram_->slot(reaction_)]; }
  GateStatus& gate() { return context_[diagram_->slot(gate_)]; }
  TickTiming& timing() { return context_[diagram_->slot(*sources_.timing)]; }
  LinkStatus& joints_link() { return context_[diagram_->slot(joints_link_)]; }
  LinkStatus& drives_link() { return context_[diagram_->slot(drives_link_)]; }

  const Diagram& diagram() const { return *diagram_; }
  const EventSources& sources() const { return sources_; }
  Time now() const { return context_.time(); }

  void tick(EventPublisher& publisher) {
    publisher.set_inputs(context_);
    diagram_->evaluate(context_);
    publisher.take_outputs(context_);
    context_.set_time(context_.time() + 1ms);
  }

 private:
  template <class T>
  static InputPort<T> relay(DiagramBuilder& builder, const std::string& name, OutputPort<T>& output) {
    auto& block = builder.add<Relay<T>>(name);
    output = block.out;
    return builder.export_input(name + "_set", block.in);
  }

  std::unique_ptr<Diagram> build() {
    DiagramBuilder builder;
    detection_ = relay(builder, "detection", sources_.detection.emplace());
    reaction_ = relay(builder, "reaction", sources_.reaction.emplace());
    gate_ = relay(builder, "gate", sources_.gate.emplace());
    sources_.timing = builder.input<TickTiming>("timing");
    sources_.links.resize(2);
    joints_link_ = relay(builder, "joints_link", sources_.links[0]);
    drives_link_ = relay(builder, "drives_link", sources_.links[1]);
    return builder.build();
  }

  EventSources sources_;
  InputPort<ContactDetection> detection_;
  InputPort<ReactionState> reaction_;
  InputPort<GateStatus> gate_;
  InputPort<LinkStatus> joints_link_, drives_link_;
  std::unique_ptr<Diagram> diagram_;
  Context context_;
};

/// Reads a topic as any program may: reliably, all of it, from when it is matched.
template <class Sample>
class PlainReader {
 public:
  PlainReader(const DdsBus& bus, const Topic& topic)
      : topic_(dds_create_topic(bus.participant(), topic.type, topic.name, nullptr, nullptr)) {
    dds_qos_t* qos = dds_create_qos();
    dds_qset_reliability(qos, DDS_RELIABILITY_RELIABLE, DDS_SECS(1));
    dds_qset_history(qos, DDS_HISTORY_KEEP_ALL, 0);
    reader_ = DdsEntity(dds_create_reader(bus.participant(), topic_.handle(), qos, nullptr));
    dds_delete_qos(qos);
  }

  std::optional<Sample> take() {
    Sample sample{};
    void* samples[1] = {&sample};
    dds_sample_info_t info{};
    while (dds_take(reader_.handle(), samples, &info, 1, 1) == 1) {
      if (info.valid_data) return sample;
    }
    return std::nullopt;
  }

  /// The next `count` samples, or fewer if they do not come within 5 s.
  std::vector<Sample> wait_for(std::size_t count) {
    std::vector<Sample> all;
    const Time end = MonotonicClock::now() + 5s;
    while (all.size() < count && MonotonicClock::now() < end) {
      if (const auto sample = take()) {
        all.push_back(*sample);
      } else {
        std::this_thread::sleep_for(1ms);
      }
    }
    return all;
  }

  /// How many more come while nothing shall.
  std::size_t leftovers() {
    std::this_thread::sleep_for(50ms);
    std::size_t count = 0;
    while (take()) ++count;
    return count;
  }

 private:
  DdsEntity topic_, reader_;
};

using EventReader = PlainReader<flinch_ContactEvent>;
using DiagnosticsReader = PlainReader<flinch_Diagnostics>;

void touch(ScriptedController& controller, ContactLevel level, const PlatformVector& wrench) {
  ContactDetection& detection = controller.detection();
  detection.valid = true;
  detection.level = detection.present_level = level;
  detection.detected = controller.now();
  detection.wrench_in_base = wrench;
}

// ---------------------------------------------------------------- events

TEST(EventPublisher, SendsEachEventOfAContactOnceInOrder) {
  const DdsBus bus({.domain = test::free_domain()});
  ScriptedController controller;
  EventReader reader(bus, contact_event_topic);
  EventPublisher publisher(bus, controller.diagram(), controller.sources(), {.robot = 7, .session = 99});
  const Time start = MonotonicClock::now();
  const auto ticks = [&](int count) {
    for (int i = 0; i < count; ++i) controller.tick(publisher);
  };

  const Eigen::Vector3d first(10, 20, 3), second(-5, 0, 1);
  ticks(20);
  controller.detection().valid = true;
  controller.reaction().mode = ReactionMode::nominal;
  ticks(20);
  touch(controller, ContactLevel::reaction, first);
  controller.reaction().mode = ReactionMode::react;
  ticks(1);
  controller.detection().present_level = ContactLevel::none;  // the level stays, until a reset
  ticks(20);
  controller.detection().level = ContactLevel::hard;
  ticks(20);
  controller.reaction().mode = ReactionMode::zero_g;
  ticks(1);
  touch(controller, ContactLevel::hard, second);  // a reset, and touched in the same tick
  ticks(20);
  controller.detection() = {.valid = true, .wrench_in_base = {}};
  controller.reaction().mode = ReactionMode::nominal;
  ticks(20);

  struct Expected {
    ContactLevel level;
    ReactionMode mode;
    PlatformVector wrench;
  };
  const std::vector<Expected> expected = {{ContactLevel::none, ReactionMode::nominal, {}},
                                          {ContactLevel::reaction, ReactionMode::react, first},
                                          {ContactLevel::hard, ReactionMode::react, first},
                                          {ContactLevel::hard, ReactionMode::zero_g, first},
                                          {ContactLevel::hard, ReactionMode::zero_g, second},
                                          {ContactLevel::none, ReactionMode::nominal, {}}};
  const auto events = reader.wait_for(expected.size());
  ASSERT_EQ(events.size(), expected.size());
  EXPECT_EQ(reader.leftovers(), 0u);
  Time last = start;
  for (std::size_t i = 0; i < events.size(); ++i) {
    SCOPED_TRACE(i);
    const flinch_ContactEvent& event = events[i];
    EXPECT_EQ(event.level, static_cast<int>(expected[i].level));
    EXPECT_EQ(event.reaction, static_cast<int>(expected[i].mode));
    PlatformVector wrench = PlatformVector::Zero(6);
    wrench.head(expected[i].wrench.size()) = expected[i].wrench;
    EXPECT_EQ(Eigen::Map<const PlatformVector>(event.wrench_in_base, 6), wrench);
    EXPECT_EQ(event.header.count, expected[i].wrench.size());
    EXPECT_EQ(event.header.flags, flag_valid);
    EXPECT_EQ(event.header.number, i + 1);
    EXPECT_EQ(event.header.session, 99u);
    EXPECT_EQ(event.header.robot, 7u);
    EXPECT_EQ(event.header.version, protocol_version);
    EXPECT_GE(Time(event.header.acquired_ns), last);
    EXPECT_GE(event.header.sent_ns, event.header.acquired_ns);
    last = Time(event.header.acquired_ns);
  }
  EXPECT_EQ(publisher.lost(), 0u);
}

/// A pipe that copies of this program share.
struct Pipe {
  Pipe() {
    if (::pipe(ends) != 0) throw std::runtime_error("no pipe");
  }
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;
  ~Pipe() {
    ::close(ends[0]);
    ::close(ends[1]);
  }
  int ends[2] = {};
};

/// A program of its own that reads the events of a bus and hands them on.
class ReadingProgram {
 public:
  explicit ReadingProgram(std::uint32_t domain) : program_([this, domain] { read(domain); }) {}

  /// The next event that the program has read, if it comes within `patience`.
  std::optional<flinch_ContactEvent> next(Time patience) {
    pollfd wanted{.fd = pipe_.ends[0], .events = POLLIN, .revents = 0};
    const auto limit = std::chrono::duration_cast<std::chrono::milliseconds>(patience);
    flinch_ContactEvent event;
    if (::poll(&wanted, 1, static_cast<int>(limit.count())) != 1) return std::nullopt;
    if (::read(pipe_.ends[0], &event, sizeof event) != sizeof event) return std::nullopt;
    return event;
  }

 private:
  [[noreturn]] void read(std::uint32_t domain) const {
    const DdsBus bus({.domain = domain});
    EventReader reader(bus, contact_event_topic);
    for (;;) {
      for (const flinch_ContactEvent& event : reader.wait_for(1)) {
        if (::write(pipe_.ends[1], &event, sizeof event) != sizeof event) ::_exit(1);
      }
    }
  }

  Pipe pipe_;
  test::OtherProgram program_;
};

TEST(EventPublisher, SendsABurstOf50EventsIn50TicksToAnotherProgram) {
  const std::uint32_t domain = test::free_domain();
  ReadingProgram other(domain);
  const DdsBus bus({.domain = domain});
  ScriptedController controller;
  EventPublisher publisher(bus, controller.diagram(), controller.sources(), {});
  std::uint32_t sent = 0;
  const auto happen = [&] {
    const double number = ++sent;
    touch(controller, ContactLevel::reaction, Eigen::Vector3d(number, -number, 1.0 / number));
    controller.tick(publisher);
  };

  for (const Time end = MonotonicClock::now() + 10s; !other.next(10ms);) {
    ASSERT_LT(MonotonicClock::now(), end) << "the other program hears nothing";
    happen();
  }
  while (other.next(200ms)) {
  }
  const std::uint32_t before = sent;
  for (int i = 0; i < 50; ++i) happen();
  for (std::uint32_t number = before + 1; number <= before + 50; ++number) {
    const auto event = other.next(5s);
    ASSERT_TRUE(event) << "event " << number;
    EXPECT_EQ(event->header.number, number);
    EXPECT_EQ(event->wrench_in_base[0], number);
    EXPECT_EQ(event->wrench_in_base[2], 1.0 / number);
  }
  EXPECT_FALSE(other.next(100ms));
  EXPECT_EQ(publisher.lost(), 0u);
}

TEST(EventPublisher, TellsWhoComesLaterOnlyWhatHappensFromThenOn) {
  const DdsBus bus({.domain = test::free_domain()});
  ScriptedController controller;
  EventReader early(bus, contact_event_topic);
  EventPublisher publisher(bus, controller.diagram(), controller.sources(), {});
  touch(controller, ContactLevel::reaction, Eigen::Vector3d(1, 2, 3));
  controller.tick(publisher);
  ASSERT_EQ(early.wait_for(1).size(), 1u);

  EventReader late(bus, contact_event_topic);
  touch(controller, ContactLevel::hard, Eigen::Vector3d(4, 5, 6));
  controller.tick(publisher);
  const auto events = late.wait_for(1);
  ASSERT_EQ(events.size(), 1u);
  EXPECT_EQ(events[0].header.number, 2u);
  EXPECT_EQ(events[0].wrench_in_base[0], 4.0);
  EXPECT_EQ(late.leftovers(), 0u);
}

TEST(EventPublisher, CountsWhatItCannotSendAndLeavesAGapInTheNumbers) {
  const DdsBus bus({.domain = test::free_domain()});
  ScriptedController controller;
  EventReader reader(bus, contact_event_topic);
  constexpr std::uint32_t happened = 20'000;  // far faster than they can be sent
  std::vector<flinch_ContactEvent> events;
  std::uint32_t lost = 0;
  {
    EventPublisher publisher(bus, controller.diagram(), controller.sources(), {});
    for (std::uint32_t i = 0; i < happened; ++i) {
      touch(controller, ContactLevel::reaction, Eigen::Vector3d(i, 0, 0));
      controller.tick(publisher);
    }
    // Nothing more happens: what waits goes out in the end.
    const Time end = MonotonicClock::now() + 10s;
    while (events.size() + publisher.lost() < happened && MonotonicClock::now() < end) {
      while (const auto event = reader.take()) events.push_back(*event);
    }
    lost = publisher.lost();
  }
  EXPECT_EQ(events.size() + lost, happened);
  EXPECT_GT(lost, 0u);
  EXPECT_GE(events.size(), 128u);  // what fits into the queue
  for (std::size_t i = 0; i < events.size(); ++i) {
    if (i > 0) {
      EXPECT_GT(events[i].header.number, events[i - 1].header.number);
    }
    EXPECT_EQ(events[i].wrench_in_base[0], events[i].header.number - 1);
  }
}

TEST(EventPublisher, SendsWhatIsLeftBeforeItEnds) {
  const DdsBus bus({.domain = test::free_domain()});
  EventReader reader(bus, contact_event_topic);
  for (int round = 0; round < 20; ++round) {
    ScriptedController controller;
    {
      EventPublisher publisher(bus, controller.diagram(), controller.sources(), {});
      for (int i = 0; i < 30; ++i) {
        touch(controller, ContactLevel::reaction, Eigen::Vector3d(i, 0, 0));
        controller.tick(publisher);
      }
    }
    ASSERT_EQ(reader.wait_for(30).size(), 30u) << "round " << round;
  }
}

// ---------------------------------------------------------------- diagnostics

TEST(EventPublisher, TellsTenTimesASecondHowTheLoopRuns) {
  const DdsBus bus({.domain = test::free_domain()});
  ScriptedController controller;
  DiagnosticsReader reader(bus, diagnostics_topic);
  EventPublisher publisher(bus, controller.diagram(), controller.sources(), {.robot = 7, .session = 99});
  controller.gate() = {.phase = GatePhase::closed,
                       .fault = GateFault::joints_stale,
                       .faults = fault_bit(GateFault::joints_stale) | fault_bit(GateFault::drives_stale)};
  controller.joints_link().skipped = 3;
  controller.drives_link().skipped = 4;
  controller.drives_link().refused = 5;
  for (std::uint32_t second_tenth = 1; second_tenth <= 3; ++second_tenth) {
    for (int i = 0; i < 100; ++i) {
      controller.timing().valid = true;
      controller.timing().lost_periods = i == 7 ? 2 : 0;
      controller.timing().previous.valid = true;
      controller.timing().previous.overran = i % 50 == 1;
      EXPECT_FALSE(reader.take());
      controller.tick(publisher);
    }
    const auto told = reader.wait_for(1);
    ASSERT_EQ(told.size(), 1u);
    EXPECT_EQ(told[0].header.number, second_tenth);
    EXPECT_EQ(told[0].header.flags, flag_valid | flag_timing_known | flag_links_known);
    EXPECT_EQ(told[0].header.session, 99u);
    EXPECT_EQ(told[0].gate_phase, 2);
    EXPECT_EQ(told[0].gate_fault, static_cast<int>(GateFault::joints_stale));
    EXPECT_EQ(told[0].gate_faults, controller.gate().faults);
    EXPECT_EQ(told[0].ticks, 100 * second_tenth);
    EXPECT_EQ(told[0].overruns, 2 * second_tenth);
    EXPECT_EQ(told[0].lost_periods, 2 * second_tenth);
    EXPECT_EQ(told[0].skipped, 7u);
    EXPECT_EQ(told[0].refused, 5u);
    EXPECT_EQ(told[0].events_lost, 0u);
  }
}

TEST(EventPublisher, SaysWhatItDoesNotKnow) {
  const DdsBus bus({.domain = test::free_domain()});
  ScriptedController controller;
  EventReader events(bus, contact_event_topic);
  DiagnosticsReader diagnostics(bus, diagnostics_topic);
  EventPublisher publisher(bus, controller.diagram(), {}, {});
  touch(controller, ContactLevel::hard, Eigen::Vector3d(1, 2, 3));
  controller.gate().phase = GatePhase::open;
  controller.timing().valid = true;
  controller.timing().lost_periods = 1;
  for (int i = 0; i < 100; ++i) controller.tick(publisher);
  const auto told = diagnostics.wait_for(1);
  ASSERT_EQ(told.size(), 1u);
  EXPECT_EQ(told[0].header.flags, 0);
  EXPECT_NE(told[0].header.session, 0u);
  EXPECT_EQ(told[0].gate_phase, 0);
  EXPECT_EQ(told[0].lost_periods, 0u);
  EXPECT_EQ(told[0].ticks, 100u);
  EXPECT_EQ(events.leftovers(), 0u);
}

// ---------------------------------------------------------------- the control thread, set-up

TEST(EventPublisher, NeverAllocatesOnTheControlThread) {
  const DdsBus bus({.domain = test::free_domain()});
  ScriptedController controller;
  EventReader reader(bus, contact_event_topic);
  EventPublisher publisher(bus, controller.diagram(), controller.sources(), {});
  controller.tick(publisher);
  const test::AllocationCounter counter;
  for (int i = 0; i < 1000; ++i) {
    if (i % 3 == 0) touch(controller, ContactLevel::reaction, Eigen::Vector3d(i, 0, 0));
    controller.tick(publisher);
  }
  EXPECT_EQ(counter.count(), 0);
}

TEST(EventPublisher, RefusesPortsOfAnotherDiagram) {
  const DdsBus bus({.domain = test::free_domain()});
  const ScriptedController controller, other;
  EXPECT_THROW(EventPublisher(bus, controller.diagram(), other.sources(), {}), SetupError);
}

}  // namespace
}  // namespace flinch
