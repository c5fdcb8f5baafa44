#include <dds/dds.h>
#include <drivers/idl/ros2.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <functional>
#include <iostream>
#include <limits>
#include <span>

#include "drivers/ros2_publisher.h"
#include "drivers/topics.h"
#include "systems/framework/diagram_builder.h"
#include "systems/framework/monotonic_clock.h"
#include "tests/peer/fast_dds/fast_dds_program.h"
#include "tests/peer/fast_dds/message_text.h"
#include "tests/support/free_domain.h"

namespace flinch {
namespace {

using test::FastDdsProgram;
using test::MessageText;

constexpr std::size_t asked = 288;   // messages on each topic, at least
constexpr Time between_ticks = 5ms;  // no message waits for the one before: far below loss
constexpr int diagnosers = 20;       // each sends diagnostics ten times a second

// ---------------------------------------------------------------- what is published

/// Tick k of the robot: numbers that use every bit, and those that are easily damaged on a way.
double number(std::int64_t tick, int place) {
  constexpr double delicate[] = {-0.0,
                                 std::numeric_limits<double>::denorm_min(),
                                 std::numeric_limits<double>::max(),
                                 std::numeric_limits<double>::lowest(),
                                 std::numeric_limits<double>::infinity(),
                                 std::numeric_limits<double>::quiet_NaN(),
                                 std::numeric_limits<double>::epsilon()};
  if (place == 0) return static_cast<double>(tick);
  if (place == 1) return delicate[static_cast<std::size_t>(tick) % std::size(delicate)];
  return std::sin(static_cast<double>(tick + 1) * place) / 3.0;
}

Eigen::Vector3d numbers(std::int64_t tick, int place) {
  return {number(tick, place), number(tick, place + 1), number(tick, place + 2)};
}

/// Shows these numbers at every port.
class Robot final : public System {
 public:
  OutputPort<JointMotion> joints = output<&Robot::move>("joints", clock);
  OutputPort<DriveTorque> torque = output<&Robot::drive>("torque", clock);
  OutputPort<ImuReading> imu = output<&Robot::turn>("imu", clock);
  OutputPort<WrenchEstimate> wrench = output<&Robot::touch>("wrench", clock);

 private:
  JointMotion move(Time now) const {
    const std::int64_t tick = now / between_ticks;
    return {.acquired = now, .valid = true, .position = numbers(tick, 0), .velocity = numbers(tick, 3)};
  }
  DriveTorque drive(Time now) const {
    return {.acquired = now, .valid = true, .torque = numbers(now / between_ticks, 6)};
  }
  ImuReading turn(Time now) const {
    const std::int64_t tick = now / between_ticks;
    return {.acquired = now,
            .valid = true,
            .angular_velocity = numbers(tick, 0),
            .specific_force = numbers(tick, 3)};
  }
  WrenchEstimate touch(Time now) const {
    return {.acquired = now,
            .valid = true,
            .wrench_in_base = numbers(now / between_ticks, 0),
            .drive_torque = {}};
  }
};

/// A torque gate that tells of a fault of its own, so that what is told differs from gate to gate.
class Gate final : public System {
 public:
  explicit Gate(int index) : index_(index) {}
  OutputPort<GateStatus> status = output<&Gate::report>("status", clock);

 private:
  GateStatus report(Time) const {
    GateStatus told;
    told.phase = static_cast<GatePhase>(index_ % 3);
    told.fault = static_cast<GateFault>(index_);
    return told;
  }
  int index_;
};

/// A diagram that is shown to ROS 2.
class Shown {
 public:
  Shown(const DdsBus& bus, DiagramBuilder& builder, const Ros2Sources& sources)
      : diagram_(builder.build()),
        context_(diagram_->make_context()),
        publisher_(bus, *diagram_, sources,
                   {.joint_names = {"drive_1", "drive \"2\"", ""},
                    .space = ConfigurationSpace::Kind::planar_pose,
                    .imu_frame = "imu link"}) {}

  void tick() {
    publisher_.set_inputs(context_);
    diagram_->evaluate(context_);
    publisher_.take_outputs(context_);
    context_.set_time(context_.time() + between_ticks);
  }

 private:
  std::unique_ptr<Diagram> diagram_;
  Context context_;
  Ros2Publisher publisher_;
};

std::vector<std::unique_ptr<Shown>> show_everything(const DdsBus& bus) {
  std::vector<std::unique_ptr<Shown>> all;
  DiagramBuilder builder;
  const auto& robot = builder.add<Robot>("robot");
  Ros2Sources sources;
  sources.joint_motion = robot.joints;
  sources.drive_torque = robot.torque;
  sources.imu = robot.imu;
  sources.wrench = robot.wrench;
  all.push_back(std::make_unique<Shown>(bus, builder, sources));
  for (int i = 0; i < diagnosers; ++i) {
    DiagramBuilder gate_builder;
    Ros2Sources gate;
    gate.gate = gate_builder.add<Gate>("gate", i).status;
    all.push_back(std::make_unique<Shown>(bus, gate_builder, gate));
  }
  return all;
}

// ---------------------------------------------------------------- what was published, by our own reader

void add(MessageText& text, const std_msgs_msg_dds__Header_& header) {
  text.add(header.stamp_.sec_);
  text.add(header.stamp_.nanosec_);
  text.add(std::string_view(header.frame_id_));
}

void add(MessageText& text, std::span<const double> values) {
  for (const double value : values) text.add(value);
}

void add(MessageText& text, const dds_sequence_double& sequence) {
  text.add(sequence._length);
  add(text, std::span(sequence._buffer, sequence._length));
}

void add(MessageText& text, const geometry_msgs_msg_dds__Vector3_& v) {
  add(text, std::array{v.x_, v.y_, v.z_});
}

void add(MessageText& text, const sensor_msgs_msg_dds__JointState_& message) {
  add(text, message.header_);
  text.add(message.name_._length);
  for (std::uint32_t i = 0; i < message.name_._length; ++i)
    text.add(std::string_view(message.name_._buffer[i]));
  add(text, message.position_);
  add(text, message.velocity_);
  add(text, message.effort_);
}

void add(MessageText& text, const sensor_msgs_msg_dds__Imu_& message) {
  add(text, message.header_);
  const auto& q = message.orientation_;
  add(text, std::array{q.x_, q.y_, q.z_, q.w_});
  add(text, message.orientation_covariance_);
  add(text, message.angular_velocity_);
  add(text, message.angular_velocity_covariance_);
  add(text, message.linear_acceleration_);
  add(text, message.linear_acceleration_covariance_);
}

void add(MessageText& text, const geometry_msgs_msg_dds__WrenchStamped_& message) {
  add(text, message.header_);
  add(text, message.wrench_.force_);
  add(text, message.wrench_.torque_);
}

void add(MessageText& text, const diagnostic_msgs_msg_dds__DiagnosticArray_& message) {
  add(text, message.header_);
  text.add(message.status_._length);
  for (const auto& status : std::span(message.status_._buffer, message.status_._length)) {
    text.add(status.level_);
    for (const char* word : {status.name_, status.message_, status.hardware_id_})
      text.add(std::string_view(word));
    text.add(status.values_._length);
    for (const auto& pair : std::span(status.values_._buffer, status.values_._length)) {
      text.add(std::string_view(pair.key_));
      text.add(std::string_view(pair.value_));
    }
  }
}

/// Keeps every message of a topic as text: in the publisher's process none is lost.
class Witness {
 public:
  virtual ~Witness() = default;
  virtual void look() = 0;
  virtual const std::string& topic() const = 0;

  const std::vector<std::string>& seen() const { return seen_; }
  /// From here on the other end shall miss none.
  void mark() { marked_ = seen_.size(); }
  std::span<const std::string> seen_since_mark() const { return std::span(seen_).subspan(marked_); }

 protected:
  std::vector<std::string> seen_;

 private:
  std::size_t marked_ = 0;
};

template <class Message>
class WitnessOf final : public Witness {
 public:
  WitnessOf(const DdsBus& bus, const Topic& topic, std::function<void(const Message&)> check)
      : name_(topic.name),
        type_(topic.type),
        check_(std::move(check)),
        topic_(dds_create_topic(bus.participant(), topic.type, topic.name, nullptr, nullptr)) {
    dds_qos_t* qos = dds_create_qos();
    dds_qset_reliability(qos, DDS_RELIABILITY_RELIABLE, DDS_SECS(1));
    dds_qset_history(qos, DDS_HISTORY_KEEP_ALL, 0);
    reader_ = DdsEntity(dds_create_reader(bus.participant(), topic_.handle(), qos, nullptr));
    dds_delete_qos(qos);
  }
  WitnessOf(const WitnessOf&) = delete;
  WitnessOf& operator=(const WitnessOf&) = delete;
  ~WitnessOf() override { dds_sample_free(&message_, type_, DDS_FREE_CONTENTS); }

  void look() override {
    void* samples[1] = {&message_};
    dds_sample_info_t info{};
    while (dds_take(reader_.handle(), samples, &info, 1, 1) == 1) {
      if (!info.valid_data) continue;
      check_(message_);
      MessageText text;
      add(text, message_);
      seen_.push_back(text.line());
    }
  }
  const std::string& topic() const override { return name_; }

 private:
  std::string name_;
  const dds_topic_descriptor_t* type_;
  std::function<void(const Message&)> check_;
  Message message_{};
  DdsEntity topic_, reader_;
};

bool same_bits(double a, double b) {
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}

/// The witnesses know what the robot shows, too.
void check_joints(const sensor_msgs_msg_dds__JointState_& message) {
  ASSERT_EQ(message.position_._length, 3u);
  ASSERT_EQ(message.effort_._length, 3u);
  const auto tick = static_cast<std::int64_t>(message.position_._buffer[0]);
  for (int i = 0; i < 3; ++i) {
    EXPECT_TRUE(same_bits(message.position_._buffer[i], number(tick, i)));
    EXPECT_TRUE(same_bits(message.velocity_._buffer[i], number(tick, 3 + i)));
    EXPECT_TRUE(same_bits(message.effort_._buffer[i], number(tick, 6 + i)));
  }
}

void check_imu(const sensor_msgs_msg_dds__Imu_& message) {
  const auto tick = static_cast<std::int64_t>(message.angular_velocity_.x_);
  EXPECT_TRUE(same_bits(message.angular_velocity_.y_, number(tick, 1)));
  EXPECT_TRUE(same_bits(message.linear_acceleration_.z_, number(tick, 5)));
}

void check_wrench(const geometry_msgs_msg_dds__WrenchStamped_& message) {
  const auto tick = static_cast<std::int64_t>(message.wrench_.force_.x_);
  EXPECT_TRUE(same_bits(message.wrench_.force_.y_, number(tick, 1)));
  EXPECT_TRUE(same_bits(message.wrench_.torque_.z_, number(tick, 2)));
}

void check_diagnostics(const diagnostic_msgs_msg_dds__DiagnosticArray_& message) {
  ASSERT_EQ(message.status_._length, 1u);
  EXPECT_EQ(message.status_._buffer[0].values_._length, 1u);
}

std::vector<std::unique_ptr<Witness>> witnesses(const DdsBus& bus) {
  using JointState = sensor_msgs_msg_dds__JointState_;
  using Imu = sensor_msgs_msg_dds__Imu_;
  using Wrench = geometry_msgs_msg_dds__WrenchStamped_;
  using Diagnostics = diagnostic_msgs_msg_dds__DiagnosticArray_;
  std::vector<std::unique_ptr<Witness>> all;
  all.push_back(std::make_unique<WitnessOf<JointState>>(bus, ros2_joint_states_topic, &check_joints));
  all.push_back(std::make_unique<WitnessOf<Imu>>(bus, ros2_imu_topic, &check_imu));
  all.push_back(std::make_unique<WitnessOf<Wrench>>(bus, ros2_contact_wrench_topic, &check_wrench));
  all.push_back(std::make_unique<WitnessOf<Diagnostics>>(bus, ros2_diagnostics_topic, &check_diagnostics));
  return all;
}

// ---------------------------------------------------------------- the comparison

/// Those of `part` that `whole` does not have, each as often as it is missing.
std::vector<std::string> missing(std::vector<std::string> part, std::vector<std::string> whole) {
  std::sort(part.begin(), part.end());
  std::sort(whole.begin(), whole.end());
  std::vector<std::string> difference;
  std::set_difference(part.begin(), part.end(), whole.begin(), whole.end(), std::back_inserter(difference));
  return difference;
}

/// Publishes until both ends have seen enough and nothing is under way; everything is compared afterwards.
class Exchanged {
 public:
  explicit Exchanged(const char* reliability)
      : domain_(test::free_domain()),
        program_(domain_, reliability),
        bus_({.domain = domain_}),
        witnesses_(witnesses(bus_)) {
    auto shown = show_everything(bus_);
    run(shown, 20s, [this](const Witness& w) { return hears_all(w); });
    for (const auto& witness : witnesses_) witness->mark();
    run(shown, 20s, [this](const Witness& w) {
      return w.seen_since_mark().size() >= asked && w.seen_since_mark().size() - lost(w).size() >= asked;
    });
    shown.clear();  // what they have still to send goes out
    run(shown, 5s, [this](const Witness& w) { return lost(w).empty(); });
  }

  const std::vector<std::unique_ptr<Witness>>& topics() const { return witnesses_; }
  std::vector<std::string> received(const Witness& witness) const {
    return program_.messages(witness.topic());
  }
  /// Those since the mark that have not arrived.
  std::vector<std::string> lost(const Witness& witness) const {
    const auto published = witness.seen_since_mark();
    return missing({published.begin(), published.end()}, received(witness));
  }

 private:
  /// Whether every sender of the topic is heard: each has sent one of the messages that must have arrived.
  bool hears_all(const Witness& witness) const {
    constexpr std::size_t under_way = diagnosers, arrived = 2 * diagnosers;
    const auto& seen = witness.seen();
    if (seen.size() < arrived + under_way) return false;
    const auto end = seen.end() - under_way;
    return missing({end - arrived, end}, received(witness)).empty();
  }

  /// Ticks until `holds` does for each topic.
  void run(const std::vector<std::unique_ptr<Shown>>& shown, Time longest,
           const std::function<bool(const Witness&)>& holds) {
    const Time end = MonotonicClock::now() + longest;
    bool done = false;
    for (Time due = MonotonicClock::now(); due < end && !done; due += between_ticks) {
      MonotonicClock::sleep_until(due);
      for (const auto& diagram : shown) diagram->tick();
      for (const auto& witness : witnesses_) witness->look();
      done = std::all_of(witnesses_.begin(), witnesses_.end(), [&](const auto& w) { return holds(*w); });
    }
  }

  std::uint32_t domain_;
  FastDdsProgram program_;  // begins before the threads of the bus
  DdsBus bus_;
  std::vector<std::unique_ptr<Witness>> witnesses_;
};

/// Whether `part` keeps the order of `whole`.
bool is_subsequence(const std::vector<std::string>& part, const std::vector<std::string>& whole) {
  auto at = whole.begin();
  for (const std::string& message : part) {
    at = std::find(at, whole.end(), message);
    if (at == whole.end()) return false;
    ++at;
  }
  return true;
}

/// Whatever arrived was published, once, and in this order; returns what did not arrive.
std::vector<std::string> compare(const Exchanged& exchanged, const Witness& witness) {
  const std::vector<std::string> received = exchanged.received(witness);
  const auto published = witness.seen_since_mark();
  const std::vector<std::string> lost = exchanged.lost(witness);
  std::cout << witness.topic() << ": " << published.size() << " published, " << published.size() - lost.size()
            << " received bit for bit, " << lost.size() << " lost" << std::endl;
  EXPECT_GE(published.size(), asked);
  const auto invented = missing(received, witness.seen());
  EXPECT_TRUE(invented.empty()) << invented.size() << " differ, e.g." << invented.front();
  if (witness.topic() != ros2_diagnostics_topic.name) {  // that one has many senders
    EXPECT_TRUE(is_subsequence(received, witness.seen()));
  }
  return lost;
}

TEST(Ros2Agreement, FastDdsReceivesEveryMessageBitForBitWhenItAsksForAll) {
  const Exchanged exchanged("reliable");
  for (const auto& witness : exchanged.topics()) {
    const auto lost = compare(exchanged, *witness);
    EXPECT_TRUE(lost.empty()) << lost.size() << " lost, e.g." << lost.front();
  }
}

TEST(Ros2Agreement, FastDdsReceivesTheSameBitsWhenItTakesWhatComes) {
  const Exchanged exchanged("best_effort");
  for (const auto& witness : exchanged.topics()) {
    const auto lost = compare(exchanged, *witness);
    EXPECT_GE(witness->seen_since_mark().size() - lost.size(), asked);
  }
}

}  // namespace
}  // namespace flinch
