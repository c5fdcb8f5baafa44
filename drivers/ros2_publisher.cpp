#include "drivers/ros2_publisher.h"

#include <drivers/idl/ros2.h>

#include <chrono>

#include "drivers/dds_writer.h"
#include "drivers/optional_slot.h"
#include "drivers/ros2_messages.h"
#include "drivers/sending_thread.h"
#include "drivers/tick_clock.h"
#include "systems/foundation/setup_error.h"
#include "systems/framework/triple_buffer.h"
#include "systems/safety/fault_table.h"

namespace flinch {
namespace {

/// All that one tick has to show.
struct Snapshot {
  Time taken{};  ///< monotonic
  JointMotion joints;
  PlatformMotion motion;
  DriveTorque torque;
  ImuReading imu;
  WrenchEstimate wrench;
  GateStatus gate;
};

/// The wall-clock time of a monotonic one.
Time wall_clock(Time monotonic) {
  const Time now = std::chrono::system_clock::now().time_since_epoch();
  return now - (MonotonicClock::now() - monotonic);
}

const char* describe(GateFault fault) {
  const auto table = fault_table();
  const auto index = static_cast<std::size_t>(fault);
  return index == 0 || index > table.size() ? "none" : table[index - 1].description;
}

}  // namespace

class Ros2Publisher::Implementation {
 public:
  Implementation(const DdsBus& bus, const Diagram& diagram, const Ros2Sources& sources,
                 const Ros2Settings& settings)
      : settings_(settings),
        clock_(diagram.tick()),
        joints_(diagram, sources.joint_motion),
        motion_(diagram, sources.motion),
        torque_(diagram, sources.drive_torque),
        imu_(diagram, sources.imu),
        wrench_(diagram, sources.wrench),
        gate_(diagram, sources.gate) {
    if (settings.ticks_between_messages < 1) throw SetupError("ticks_between_messages must be at least 1");
    for (std::string& name : settings_.joint_names) names_.push_back(name.data());
    for (std::string& name : settings_.model.names) model_names_.push_back(name.data());
    if (joints_.exists() || (motion_.exists() && !model_names_.empty()))
      joint_writer_.emplace(bus, ros2_joint_states_topic);
    if (imu_.exists()) imu_writer_.emplace(bus, ros2_imu_topic);
    if (wrench_.exists()) wrench_writer_.emplace(bus, ros2_contact_wrench_topic);
    if (gate_.exists()) diagnostics_writer_.emplace(bus, ros2_diagnostics_topic);
    thread_.emplace([this] { publish(); }, 0);
  }

  void set_inputs(Context& context) noexcept { clock_.start_tick(context.time()); }

  void take_outputs(const Context& context) noexcept {
    if (++tick_ % settings_.ticks_between_messages != 0) return;
    next_.taken = clock_.to_monotonic(context.time());
    joints_.copy(context, next_.joints);
    motion_.copy(context, next_.motion);
    torque_.copy(context, next_.torque);
    imu_.copy(context, next_.imu);
    wrench_.copy(context, next_.wrench);
    gate_.copy(context, next_.gate);
    left_.publish(next_);
    thread_->wake();
  }

 private:
  /// On the sending thread from here on.
  void publish() {
    if (!left_.take(now_)) return;
    if (joint_writer_ && now_.joints.valid) publish_joints();
    if (joint_writer_ && now_.motion.valid() && !model_names_.empty()) publish_model();
    if (imu_writer_ && now_.imu.valid) publish_imu();
    if (wrench_writer_ && now_.wrench.valid) publish_wrench();
    if (diagnostics_writer_ && now_.taken - last_diagnostics_ >= 100ms) publish_diagnostics();
  }

  void publish_joints() {
    sensor_msgs_msg_dds__JointState_ message{};
    to_ros2(wall_clock(now_.taken), settings_.base_frame, message.header_);
    to_ros2(now_.joints, now_.torque, names_, message);
    joint_writer_->write(&message);
  }

  void publish_model() {
    if (!settings_.model.find(now_.motion.pose, model_positions_)) return;
    sensor_msgs_msg_dds__JointState_ message{};
    to_ros2(wall_clock(now_.taken), settings_.base_frame, message.header_);
    to_ros2(model_positions_, model_names_, message);
    joint_writer_->write(&message);
  }

  void publish_imu() {
    sensor_msgs_msg_dds__Imu_ message{};
    to_ros2(wall_clock(now_.taken), settings_.imu_frame, message.header_);
    to_ros2(now_.imu, message);
    imu_writer_->write(&message);
  }

  void publish_wrench() {
    geometry_msgs_msg_dds__WrenchStamped_ message{};
    to_ros2(wall_clock(now_.taken), settings_.base_frame, message.header_);
    to_ros2(now_.wrench, settings_.space, message);
    wrench_writer_->write(&message);
  }

  void publish_diagnostics() {
    last_diagnostics_ = now_.taken;
    const auto text = [](const char* words) { return const_cast<char*>(words); };
    diagnostic_msgs_msg_dds__KeyValue_ fault{.key_ = text("first fault"),
                                             .value_ = text(describe(now_.gate.fault))};
    diagnostic_msgs_msg_dds__DiagnosticStatus_ status{};
    const GatePhase phase = now_.gate.phase;
    status.level_ = phase == GatePhase::open ? 0 : phase == GatePhase::closed ? 2 : 1;
    status.name_ = text("flinch");
    status.message_ = text(describe(now_.gate.phase));
    status.hardware_id_ = text("");
    status.values_ = {._maximum = 1, ._length = 1, ._buffer = &fault, ._release = false};
    diagnostic_msgs_msg_dds__DiagnosticArray_ message{};
    to_ros2(wall_clock(now_.taken), settings_.base_frame, message.header_);
    message.status_ = {._maximum = 1, ._length = 1, ._buffer = &status, ._release = false};
    diagnostics_writer_->write(&message);
  }

  Ros2Settings settings_;
  std::vector<char*> names_, model_names_;  // of the joints, into settings_
  std::vector<double> model_positions_;
  TickClock clock_;
  OptionalSlot<JointMotion> joints_;
  OptionalSlot<PlatformMotion> motion_;
  OptionalSlot<DriveTorque> torque_;
  OptionalSlot<ImuReading> imu_;
  OptionalSlot<WrenchEstimate> wrench_;
  OptionalSlot<GateStatus> gate_;

  std::int64_t tick_ = 0;
  Snapshot next_;
  TripleBuffer<Snapshot> left_;

  Snapshot now_;
  Time last_diagnostics_{};
  std::optional<DdsWriter> joint_writer_;
  std::optional<DdsWriter> imu_writer_;
  std::optional<DdsWriter> wrench_writer_;
  std::optional<DdsWriter> diagnostics_writer_;
  std::optional<SendingThread> thread_;  // last: ends before what it sends with
};

Ros2Publisher::Ros2Publisher(const DdsBus& bus, const Diagram& diagram, const Ros2Sources& sources,
                             const Ros2Settings& settings)
    : implementation_(std::make_unique<Implementation>(bus, diagram, sources, settings)) {}

Ros2Publisher::~Ros2Publisher() = default;

void Ros2Publisher::set_inputs(Context& context) { implementation_->set_inputs(context); }
void Ros2Publisher::take_outputs(const Context& context) { implementation_->take_outputs(context); }

}  // namespace flinch
