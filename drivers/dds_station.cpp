#include "drivers/dds_station.h"

#include <drivers/idl/flinch.h>

#include <algorithm>
#include <optional>

#include "drivers/robot_selection.h"
#include "drivers/sample_receiver.h"
#include "drivers/sample_sender.h"
#include "drivers/sending_thread.h"
#include "drivers/step_sender.h"
#include "drivers/tick_clock.h"
#include "drivers/wire_conversion.h"
#include "systems/framework/diagram.h"

namespace flinch {
namespace {

/// Brings one kind of reading from the bus to an input of the diagram.
template <class Sample, class Reading>
class ReadingInlet {
 public:
  ReadingInlet(const DdsBus& bus, const Topic& topic, const AdmissionSettings& admission,
               Slot<Arrival<Reading>> input, SampleSignal* arrived = nullptr)
      : input_(input), receiver_(bus, topic, admission, nullptr, arrived) {}

  /// Whether something has come since the last look.
  bool look_for_newer() noexcept {
    const bool newer = receiver_.take(last_);
    waiting_ = waiting_ || newer;
    return newer;
  }

  /// Whether the last that has come belongs to this tick of the simulation.
  bool is_of(Time tick) const noexcept {
    return last_.sample.header.session != 0 && Time(last_.sample.header.sent_ns) == tick;
  }

  /// Returns whether there was something new.
  bool set_inputs(Context& context, const TickClock& clock) noexcept {
    look_for_newer();
    if (!waiting_) return false;
    waiting_ = false;
    Arrival<Reading>& arrival = context[input_];
    from_wire(last_.sample, arrival.reading);
    arrival.reading.acquired = clock.to_tick_time(last_.acquired);
    arrival.source = last_.sample.header.session;
    arrival.number = last_.sample.header.number;
    return true;
  }

  const ReceivedSample<Sample>& last() const noexcept { return last_; }
  const SampleReceiver<Sample>& receiver() const noexcept { return receiver_; }

 private:
  Slot<Arrival<Reading>> input_;
  bool waiting_ = false;
  ReceivedSample<Sample> last_;
  SampleReceiver<Sample> receiver_;
};

}  // namespace

class DdsStation::Implementation {
 public:
  Implementation(const DdsBus& bus, const Diagram& diagram, const ExternalStation& station,
                 const DdsStationSettings& settings)
      : bus_(bus),
        sender_{draw_session(), settings.robot},
        period_(diagram.tick()),
        clock_(diagram.tick()),
        arriving_status_(diagram.slot(station.arriving_status)),
        torque_command_(diagram.slot(station.torque_command)),
        brake_(diagram.slot(station.brake)),
        pace_(settings.pace),
        robots_(settings.chosen_robot),
        admission_{.robot = settings.robot,
                   .robots = &robots_,
                   .longest_silence = settings.longest_silence,
                   .pace = pace_},
        joints_(bus, joints_topic, admission_, diagram.slot(station.arriving_joints), &joints_arrived_),
        drives_(bus, drives_topic, admission_, diagram.slot(station.arriving_drives), others_arrived()),
        imu_(bus, imu_topic, admission_, diagram.slot(station.arriving_imu), others_arrived()),
        status_(bus, status_topic, admission_, diagram.slot(station.arriving_status), others_arrived()),
        requests_(bus, drive_request_topic, sender_) {
    if (station.arriving_force_torque) {
      force_torque_.emplace(bus, force_torque_topic, admission_, diagram.slot(*station.arriving_force_torque),
                            others_arrived());
    }
    if (pace_ == Pace::lockstep) {
      steps_.emplace(bus, torque_command_topic, sender_);
      return;
    }
    commands_.emplace(bus, torque_command_topic, sender_);
    thread_.emplace([this] { send(); }, settings.realtime_priority);
  }

  void set_inputs(Context& context) noexcept {
    if (pace_ == Pace::lockstep) {
      clock_.stand_at(context.time());
    } else {
      clock_.start_tick(context.time());
    }
    take_robot();
    if (joints_.set_inputs(context, clock_)) time_joints();
    drives_.set_inputs(context, clock_);
    imu_.set_inputs(context, clock_);
    if (status_.set_inputs(context, clock_)) {
      StationStatus& told = context[arriving_status_].reading;
      told.enabled = told.enabled && obeys_us();
      time_echo();
    }
    if (force_torque_) force_torque_->set_inputs(context, clock_);
  }

  void take_outputs(const Context& context) noexcept {
    flinch_TorqueSample sample;
    TorqueCommand command = context[torque_command_];
    command.computed = clock_.to_monotonic(command.computed);
    to_wire(command, context[brake_], sample);
    if (pace_ == Pace::lockstep) return send_step(sample, context.time());
    commands_->leave(sample);
    thread_->wake();
  }

  void introduce() noexcept {
    if (pace_ == Pace::lockstep) return ask_for_begin();
    flinch_TorqueSample nothing{};
    nothing.header.acquired_ns = MonotonicClock::now().count();
    nothing.header.flags = flag_engage_brake;
    commands_->leave(nothing);
    thread_->wake();
  }

  void ask_for_begin() noexcept {
    begun_ = false;
    step_ = {};
    step_.header.flags = flag_begin | flag_engage_brake;
    step_time_ = before_first_tick;
    awaited_ = Time::zero();
    send_again();
  }

  Answer wait_for_tick(Time deadline) noexcept {
    do {
      look_for_newer();
      const bool is_ours = obeys_us();
      if (is_ours && all_are_of(awaited_)) {
        begun_ = true;
        return Answer::ready;
      }
      if (begun_ && !is_ours) return Answer::gone;
    } while (joints_arrived_.wait_until(deadline));
    return Answer::none;
  }

  void send_again() noexcept {
    const std::uint64_t robot_id = take_robot();
    if (robot_id == 0 || !steps_) return;
    steps_->name_robot(robot_id);
    steps_->send(step_, step_time_);
  }

  void ask_for_end() noexcept {
    step_ = {};
    step_.header.flags = flag_end | flag_engage_brake;
    step_time_ = awaited_ = before_first_tick;
    send_again();
  }

  bool wait_for_joints(Time deadline) noexcept {
    joints_.look_for_newer();
    while (!joints_.look_for_newer()) {
      if (!joints_arrived_.wait_until(deadline)) return joints_.look_for_newer();
    }
    return true;
  }

  void request(const RequestedDriveState& wish) noexcept {
    if (pace_ == Pace::lockstep) return;
    flinch_DriveRequest request{};
    request.header.acquired_ns = MonotonicClock::now().count();
    request.header.flags = flag_valid;
    request.wanted = static_cast<std::uint8_t>(wish.state);
    request.mode = 10;  // cyclic synchronous torque
    request.engage_brake = wish.engage_brake;
    request.fault_resets = wish.fault_resets;
    requests_.leave(request);
    thread_->wake();
  }

  DdsLink link() const noexcept {
    DdsLink link;
    link.received = joints_.receiver().count(Admission::admitted);
    add_refusals(joints_.receiver(), link);
    add_refusals(drives_.receiver(), link);
    add_refusals(imu_.receiver(), link);
    add_refusals(status_.receiver(), link);
    link.robot_id = robots_.taken();
    link.robots = robots_.count();
    link.period = Time(status_.last().sample.period_ns);
    link.lost = joints_.receiver().lost();
    link.deadlines_missed = joints_.receiver().qos_mismatch().deadlines;
    const ReceivedSample<flinch_StatusSample>& last = status_.last();
    link.enabled = (last.sample.header.flags & flag_valid) != 0 && last.sample.enabled != 0;
    link.drive_state = static_cast<DriveState>(last.sample.drive_state);
    link.commands_obeyed = obeys_us();
    if (link.commands_obeyed && pace_ == Pace::real_time) link.round_trip = round_trip(last);
    return link;
  }

  Time period() const noexcept { return period_; }
  Pace pace() const noexcept { return pace_; }
  int peers() const noexcept { return joints_.receiver().writers(); }
  int unreadable_robots() const { return std::max(0, writers_on(bus_, joints_topic) - peers()); }
  const DdsLinkTimes& times() const noexcept { return times_; }
  void forget_times() noexcept {
    times_ = DdsLinkTimes();
    last_joints_ = Time::zero();
  }
  std::uint32_t session() const noexcept { return sender_.session; }
  std::vector<SeenRobot> robots() const { return robots_.robots(); }
  std::uint64_t take_robot() noexcept {
    status_.look_for_newer();  // which tells the period before the first tick
    return robots_.take(MonotonicClock::now());
  }
  bool is_undecided() const noexcept { return robots_.is_undecided(MonotonicClock::now()); }

 private:
  static constexpr Time before_first_tick = Time(-1);

  /// In lockstep a tick waits for all of them.
  SampleSignal* others_arrived() noexcept { return pace_ == Pace::lockstep ? &joints_arrived_ : nullptr; }

  void send_step(flinch_TorqueSample& sample, Time tick) noexcept {
    step_ = sample;
    step_time_ = tick;
    awaited_ = tick + period_;
    send_again();
  }

  void look_for_newer() noexcept {
    joints_.look_for_newer();
    drives_.look_for_newer();
    imu_.look_for_newer();
    status_.look_for_newer();
    if (force_torque_) force_torque_->look_for_newer();
  }

  bool all_are_of(Time tick) const noexcept {
    return joints_.is_of(tick) && drives_.is_of(tick) && imu_.is_of(tick) && status_.is_of(tick) &&
           (!force_torque_ || force_torque_->is_of(tick));
  }

  /// A request waits until there is a robot to name.
  void send() noexcept {
    const std::uint64_t robot_id = robots_.taken();
    if (robot_id == 0) return;
    commands_->name_robot(robot_id);
    requests_.name_robot(robot_id);
    commands_->send();
    requests_.send();
  }

  bool obeys_us() const noexcept { return status_.last().sample.commander == sender_.session; }

  void time_joints() noexcept {
    if (pace_ == Pace::lockstep) return;
    const ReceivedSample<flinch_JointSample>& joints = joints_.last();
    times_.age.add(MonotonicClock::now() - joints.acquired);
    if (last_joints_ != Time::zero()) times_.interval.add(joints.arrived - last_joints_);
    last_joints_ = joints.arrived;
  }

  /// Of each command once: an echo stands until the next command comes.
  void time_echo() noexcept {
    const flinch_StatusSample& status = status_.last().sample;
    if (pace_ == Pace::lockstep || !obeys_us() || status.command_number == last_echo_) return;
    if (!is_clock_time(status.command_sent_ns) || !is_clock_time(status.command_received_ns)) return;
    last_echo_ = status.command_number;
    times_.round_trip.add(round_trip(status_.last()));
  }

  template <class Sample>
  static void add_refusals(const SampleReceiver<Sample>& receiver, DdsLink& link) noexcept {
    const std::uint32_t of_others = receiver.count(Admission::other_robot);
    link.refused += receiver.refused() - of_others;
    link.other_version += receiver.count(Admission::other_version);
    link.other_description += receiver.count(Admission::other_description);
    link.other_pace += receiver.count(Admission::other_pace);
    link.other_robot += of_others;
  }

  /// Each difference is of one clock, so the two need not agree.
  static Time round_trip(const ReceivedSample<flinch_StatusSample>& last) noexcept {
    const Time away = last.arrived - Time(last.sample.command_sent_ns);
    const Time kept = Time(last.sample.header.sent_ns) - Time(last.sample.command_received_ns);
    return away - kept;
  }

  const DdsBus& bus_;
  SenderIdentity sender_;
  Time period_;
  TickClock clock_;
  Slot<Arrival<StationStatus>> arriving_status_;
  Slot<TorqueCommand> torque_command_;
  Slot<BrakeCommand> brake_;
  Pace pace_;
  RobotSelection robots_;
  AdmissionSettings admission_;
  DdsLinkTimes times_;
  std::uint32_t last_echo_ = 0;
  Time last_joints_{};

  SampleSignal joints_arrived_;
  ReadingInlet<flinch_JointSample, JointReading> joints_;
  ReadingInlet<flinch_DriveSample, DriveReading> drives_;
  ReadingInlet<flinch_ImuSample, ImuReading> imu_;
  ReadingInlet<flinch_StatusSample, StationStatus> status_;
  std::optional<ReadingInlet<flinch_ForceTorqueSample, ForceTorqueReading>> force_torque_;

  // In lockstep: what was sent last, for which tick, and whose readings are waited for.
  flinch_TorqueSample step_{};
  Time step_time_ = before_first_tick;
  Time awaited_{};
  bool begun_ = false;  ///< the robot has answered a begin
  std::optional<StepSender<flinch_TorqueSample>> steps_;

  std::optional<SampleSender<flinch_TorqueSample>> commands_;  ///< in real time
  SampleSender<flinch_DriveRequest> requests_;
  std::optional<SendingThread> thread_;  // last: ends before what it sends with
};

DdsStation::DdsStation(const DdsBus& bus, const Diagram& diagram, const ExternalStation& station,
                       const DdsStationSettings& settings)
    : implementation_(std::make_unique<Implementation>(bus, diagram, station, settings)) {}

DdsStation::~DdsStation() = default;

void DdsStation::set_inputs(Context& context) { implementation_->set_inputs(context); }
void DdsStation::take_outputs(const Context& context) { implementation_->take_outputs(context); }
bool DdsStation::wait_for_joints(Time deadline) noexcept {
  return implementation_->wait_for_joints(deadline);
}
Pace DdsStation::pace() const noexcept { return implementation_->pace(); }
void DdsStation::introduce() noexcept { implementation_->introduce(); }
void DdsStation::ask_for_begin() noexcept { implementation_->ask_for_begin(); }
DdsStation::Answer DdsStation::wait_for_tick(Time deadline) noexcept {
  return implementation_->wait_for_tick(deadline);
}
void DdsStation::send_again() noexcept { implementation_->send_again(); }
void DdsStation::ask_for_end() noexcept { implementation_->ask_for_end(); }
void DdsStation::request(const RequestedDriveState& wish) noexcept { implementation_->request(wish); }
DdsLink DdsStation::link() const noexcept { return implementation_->link(); }
Time DdsStation::period() const noexcept { return implementation_->period(); }
int DdsStation::peers() const noexcept { return implementation_->peers(); }
int DdsStation::unreadable_robots() const { return implementation_->unreadable_robots(); }
std::vector<SeenRobot> DdsStation::robots() const { return implementation_->robots(); }
std::uint64_t DdsStation::take_robot() noexcept { return implementation_->take_robot(); }
bool DdsStation::is_undecided() const noexcept { return implementation_->is_undecided(); }
const DdsLinkTimes& DdsStation::times() const noexcept { return implementation_->times(); }
void DdsStation::forget_times() noexcept { implementation_->forget_times(); }
std::uint32_t DdsStation::session() const noexcept { return implementation_->session(); }

}  // namespace flinch
