#include "drivers/dds_server.h"

#include <drivers/idl/flinch.h>

#include <algorithm>
#include <optional>

#include "drivers/robot_id.h"
#include "drivers/sample_receiver.h"
#include "drivers/sample_sender.h"
#include "drivers/sending_thread.h"
#include "drivers/tick_clock.h"
#include "drivers/wire_conversion.h"
#include "systems/framework/diagram.h"

namespace flinch {
namespace {

constexpr std::uint8_t operation_enabled = 2;  // of flinch_DriveRequest::wanted

/// Brings one kind of reading from the diagram to the bus.
template <class Sample, class Reading>
class ReadingOutlet {
 public:
  ReadingOutlet(const DdsBus& bus, const Topic& topic, const SenderIdentity& sender, Slot<Reading> output)
      : output_(output), sender_(bus, topic, sender) {}

  void take_outputs(const Context& context, const TickClock& clock) noexcept {
    Sample sample;
    Reading reading = context[output_];
    reading.acquired = clock.to_monotonic(reading.acquired);
    to_wire(reading, sample);
    sender_.leave(sample);
  }

  void send() noexcept { sender_.send(); }

 private:
  Slot<Reading> output_;
  SampleSender<Sample> sender_;
};

}  // namespace

class DdsServer::Implementation {
 public:
  Implementation(const DdsBus& bus, const Diagram& diagram, const Station& station,
                 const DdsServerSettings& settings, const PoweredStation* powered = nullptr)
      : settings_(settings),
        bus_(bus),
        sender_{draw_session(), settings.robot, draw_robot_id(checked_robot_name(settings.robot_name))},
        clock_(diagram.tick()),
        period_ns_(static_cast<std::uint32_t>(diagram.tick().count())),
        torque_command_(diagram.slot(station.torque_command)),
        brake_(diagram.slot(station.brake)),
        station_status_(diagram.slot(station.status)),
        commands_(bus, torque_command_topic, admission(settings, sender_.robot_id), &asks_for_nothing),
        requests_(bus, drive_request_topic, request_admission(settings, sender_.robot_id)),
        joints_(bus, joints_topic, sender_, diagram.slot(station.joints)),
        drives_(bus, drives_topic, sender_, diagram.slot(station.drives)),
        imu_(bus, imu_topic, sender_, diagram.slot(station.imu)),
        status_(bus, status_topic, sender_) {
    if (station.force_torque) {
      force_torque_.emplace(bus, force_torque_topic, sender_, diagram.slot(*station.force_torque));
    }
    if (powered != nullptr) {
      power_ = {.wish = diagram.slot(powered->wish), .statusword = diagram.slot(powered->statusword)};
    }
    thread_.emplace([this] { send(); }, settings.realtime_priority);
  }

  void set_inputs(Context& context) noexcept {
    clock_.start_tick(context.time());
    if (commands_.take(last_)) obeying_ = obeying_ || asks_for_nothing(last_.sample);
    take_requests();
    age_ = MonotonicClock::now() - last_.sent;
    if (obeying_ && age_ > settings_.longest_silence) {
      obeying_ = false;
      request_ = {};  // who comes back asks anew before the drives are switched on
      ++silences_;
    }
    command(context[torque_command_], context[brake_]);
    if (power_) wish(context[power_->wish]);
  }

  void take_outputs(const Context& context) noexcept {
    joints_.take_outputs(context, clock_);
    drives_.take_outputs(context, clock_);
    imu_.take_outputs(context, clock_);
    if (force_torque_) force_torque_->take_outputs(context, clock_);
    leave_status(context[station_status_], drive_state(context));
    thread_->wake();
  }

  DdsCommander commander() const noexcept {
    return {.session = obeying_ ? last_.sample.header.session : 0,
            .received = commands_.count(Admission::admitted),
            .refused = commands_.refused(),
            .for_others = commands_.count(Admission::other_robot),
            .in_lockstep = commands_.count(Admission::other_pace),
            .silences = silences_,
            .age = age_};
  }

  std::uint64_t robot_id() const noexcept { return sender_.robot_id; }
  int unreadable_commanders() const {
    return std::max(0, writers_on(bus_, torque_command_topic) - commands_.writers());
  }

 private:
  struct Power {
    Slot<RequestedDriveState> wish;
    Slot<Statusword> statusword;
  };

  static AdmissionSettings admission(const DdsServerSettings& settings, std::uint64_t robot_id) {
    return {.robot = settings.robot,
            .addressee = robot_id,
            .longest_silence = settings.longest_silence,
            .longest_way = settings.longest_way,
            .begins_neutral = true,
            .once = true};
  }

  /// A request says little and seldom: whoever commands is judged by the commands, and only its request
  /// counts.
  static AdmissionSettings request_admission(const DdsServerSettings& settings, std::uint64_t robot_id) {
    return {
        .robot = settings.robot, .addressee = robot_id, .longest_silence = Time::zero(), .longest_way = 1h};
  }

  /// What others than the commander ask for waits, until they command themselves.
  void take_requests() noexcept {
    const std::uint32_t commander = last_.sample.header.session;
    while (requests_.take(new_request_)) {
      const bool of_commander = obeying_ && new_request_.sample.header.session == commander;
      if (!of_commander) {
        others_request_ = new_request_.sample;
        continue;
      }
      heed(new_request_.sample);
      if (others_request_.header.session == commander) others_request_ = {};
    }
    if (obeying_ && others_request_.header.session == commander) {
      heed(others_request_);
      others_request_ = {};
    }
  }

  /// Counts the resets that are asked for; the count of a session begins with its first request.
  void heed(const flinch_DriveRequest& request) noexcept {
    const bool same_session = request.header.session == request_.header.session;
    if (same_session && request.fault_resets > request_.fault_resets) ++fault_resets_;
    request_ = request;
  }

  /// Whether the last request is of who commands.
  bool is_asked() const noexcept {
    return obeying_ && request_.header.session == last_.sample.header.session;
  }

  /// Whether who commands has asked for brakes, or for less than operation.
  bool is_held() const noexcept {
    return is_asked() && (request_.engage_brake != 0 || request_.wanted != operation_enabled);
  }

  void wish(RequestedDriveState& wish) const noexcept {
    wish = RequestedDriveState{.fault_resets = fault_resets_};
    if (!is_asked() || request_.wanted > 3) return;
    wish.state = static_cast<RequestedDriveState::State>(request_.wanted);
    wish.engage_brake = request_.engage_brake != 0;
  }

  DriveState drive_state(const Context& context) const noexcept {
    if (power_) return context[power_->statusword].state();
    return context[station_status_].enabled ? DriveState::operation_enabled : DriveState::switch_on_disabled;
  }

  void command(TorqueCommand& torque, BrakeCommand& brake) const noexcept {
    torque = TorqueCommand();
    brake = BrakeCommand();
    if (!obeying_) return;
    from_wire(last_.sample, torque);
    from_wire(last_.sample, brake);
    brake.engage = brake.engage || is_held();
    torque.computed = clock_.to_tick_time(last_.acquired);
  }

  void leave_status(StationStatus status, DriveState drives) noexcept {
    status.acquired = clock_.to_monotonic(status.acquired);
    status.enabled = status.enabled && obeying_;
    flinch_StatusSample sample;
    to_wire(status, sample);
    sample.drive_state = static_cast<std::uint8_t>(drives);
    const DdsCommander now = commander();
    sample.commander = now.session;
    sample.period_ns = period_ns_;
    std::copy(settings_.robot_name.begin(), settings_.robot_name.end(), sample.robot_name);
    sample.commands_refused = now.refused;
    if (obeying_) {
      sample.command_number = last_.sample.header.number;
      sample.command_sent_ns = last_.sample.header.sent_ns;
      sample.command_received_ns = last_.arrived.count();
    }
    status_.leave(sample);
  }

  /// Joints last: they start a tick at the other end, which shall find all the rest.
  void send() noexcept {
    drives_.send();
    imu_.send();
    if (force_torque_) force_torque_->send();
    status_.send(settings_.longest_silence);  // brakes have closed meanwhile that it may call open
    joints_.send();
  }

  DdsServerSettings settings_;
  const DdsBus& bus_;
  SenderIdentity sender_;
  TickClock clock_;
  std::uint32_t period_ns_;
  Slot<TorqueCommand> torque_command_;
  Slot<BrakeCommand> brake_;
  Slot<StationStatus> station_status_;
  std::optional<Power> power_;

  bool obeying_ = false;
  Time age_{};
  std::uint32_t silences_ = 0;
  std::uint32_t fault_resets_ = 0;
  ReceivedSample<flinch_TorqueSample> last_;
  SampleReceiver<flinch_TorqueSample> commands_;
  flinch_DriveRequest request_{};         ///< of who commands, or commanded last
  flinch_DriveRequest others_request_{};  ///< the last of anybody else
  ReceivedSample<flinch_DriveRequest> new_request_;
  SampleReceiver<flinch_DriveRequest, SampleQueue> requests_;

  ReadingOutlet<flinch_JointSample, JointReading> joints_;
  ReadingOutlet<flinch_DriveSample, DriveReading> drives_;
  ReadingOutlet<flinch_ImuSample, ImuReading> imu_;
  std::optional<ReadingOutlet<flinch_ForceTorqueSample, ForceTorqueReading>> force_torque_;
  SampleSender<flinch_StatusSample> status_;
  std::optional<SendingThread> thread_;  // last: ends before what it sends with
};

DdsServer::DdsServer(const DdsBus& bus, const Diagram& diagram, const PoweredStation& station,
                     const DdsServerSettings& settings)
    : implementation_(std::make_unique<Implementation>(bus, diagram, station, settings, &station)) {}

DdsServer::DdsServer(const DdsBus& bus, const Diagram& diagram, const Station& station,
                     const DdsServerSettings& settings)
    : implementation_(std::make_unique<Implementation>(bus, diagram, station, settings)) {}

DdsServer::~DdsServer() = default;

void DdsServer::set_inputs(Context& context) { implementation_->set_inputs(context); }
void DdsServer::take_outputs(const Context& context) { implementation_->take_outputs(context); }
DdsCommander DdsServer::commander() const noexcept { return implementation_->commander(); }
int DdsServer::unreadable_commanders() const { return implementation_->unreadable_commanders(); }
std::uint64_t DdsServer::robot_id() const noexcept { return implementation_->robot_id(); }

}  // namespace flinch
