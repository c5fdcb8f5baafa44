#include "drivers/lockstep_server.h"

#include <drivers/idl/flinch.h>

#include <algorithm>
#include <optional>

#include "drivers/drive_state.h"
#include "drivers/robot_id.h"
#include "drivers/sample_receiver.h"
#include "drivers/step_sender.h"
#include "drivers/wire_conversion.h"
#include "systems/framework/diagram.h"
#include "systems/framework/simulator.h"

namespace flinch {
namespace {

constexpr Time until_sent_again = 20ms;  // of the wall clock

bool asks_for_begin(const flinch_TorqueSample& sample) { return (sample.header.flags & flag_begin) != 0; }
bool asks_for_end(const flinch_TorqueSample& sample) { return (sample.header.flags & flag_end) != 0; }

/// One kind of reading on the bus; without an output it is none.
template <class Sample, class Reading>
class ReadingOutlet {
 public:
  ReadingOutlet(const DdsBus& bus, const Topic& topic, const SenderIdentity& sender, const Diagram& diagram,
                std::optional<OutputPort<Reading>> output)
      : sender_(bus, topic, sender) {
    if (output) output_ = diagram.slot(*output);
  }

  void send(const Context& context) noexcept {
    Sample sample;
    to_wire(output_ ? context[*output_] : Reading(), sample);
    sender_.send(sample, context.time());
  }

 private:
  std::optional<Slot<Reading>> output_;
  StepSender<Sample> sender_;
};

}  // namespace

class LockstepServer::Implementation {
 public:
  Implementation(const DdsBus& bus, const Diagram& diagram, const Station& station,
                 const LockstepServerSettings& settings, std::unique_ptr<Integrator> integrator)
      : settings_(settings),
        bus_(bus),
        diagram_(diagram),
        simulator_(diagram, std::move(integrator)),
        context_(diagram.make_context()),
        sender_{draw_session(), settings.robot, draw_robot_id(checked_robot_name(settings.robot_name))},
        torque_command_(diagram.slot(station.torque_command)),
        brake_(diagram.slot(station.brake)),
        station_status_(diagram.slot(station.status)),
        joints_(bus, joints_topic, sender_, diagram, station.joints),
        drives_(bus, drives_topic, sender_, diagram, station.drives),
        imu_(bus, imu_topic, sender_, diagram, station.imu),
        force_torque_(bus, force_torque_topic, sender_, diagram, station.force_torque),
        status_(bus, status_topic, sender_),
        commands_(bus, torque_command_topic, admission(), &asks_for_nothing, &arrived_) {}

  void record(Recorder& recorder) { simulator_.record(recorder); }
  void run(const std::function<bool()>& over) {
    start();
    while (!over()) {
      send_readings();
      wait_for_command();
      publish();
    }
  }

  LockstepState state() {
    states_.take(last_state_);
    return last_state_;
  }
  std::uint64_t robot_id() const noexcept { return sender_.robot_id; }
  int unreadable_commanders() const {
    return std::max(0, writers_on(bus_, torque_command_topic) - commands_.writers());
  }

 private:
  AdmissionSettings admission() const {
    return {.robot = settings_.robot,
            .addressee = sender_.robot_id,
            .longest_silence = settings_.patience,
            .begins_neutral = true,
            .once = true,
            .pace = Pace::lockstep};
  }

  /// The robot stands where the scenario lets it begin.
  void start() {
    context_ = diagram_.make_context();
    simulator_.evaluate(context_);
  }

  /// For as long as it takes until something new is to be sent, or the last readings once more.
  void wait_for_command() {
    const Time deadline = MonotonicClock::now() + until_sent_again;
    do {
      while (commands_.take(last_)) {
        if (obey(last_)) return;
      }
    } while (arrived_.wait_until(deadline));
    if (controller_ == 0 || MonotonicClock::now() - last_.arrived <= settings_.patience) return;
    ++abandoned_;
    let_go();
  }

  void let_go() {
    controller_ = 0;
    start();
  }

  /// Whether there are other readings than before.
  bool obey(const ReceivedSample<flinch_TorqueSample>& command) {
    if (asks_for_end(command.sample)) {
      let_go();
      return true;
    }
    if (asks_for_begin(command.sample)) {
      begin(command.sample.header.session);
      return true;
    }
    const bool is_awaited = command.sample.header.session == controller_ &&
                            Time(command.sample.header.sent_ns) == context_.time();
    if (is_awaited) move_on(command.sample);
    return is_awaited;
  }

  void begin(std::uint32_t session) {
    if (controller_ == session && context_.time() == Time::zero()) return;
    controller_ = session;
    ++runs_;
    start();
  }

  void move_on(const flinch_TorqueSample& command) {
    from_wire(command, context_[torque_command_]);
    from_wire(command, context_[brake_]);
    simulator_.evaluate(context_);
    simulator_.advance(context_);
    simulator_.evaluate(context_);
    ++ticks_;
  }

  /// Joints last, as all ends do.
  void send_readings() noexcept {
    drives_.send(context_);
    imu_.send(context_);
    force_torque_.send(context_);
    send_status();
    joints_.send(context_);
  }

  void send_status() noexcept {
    StationStatus status = context_[station_status_];
    status.enabled = status.enabled && controller_ != 0;
    flinch_StatusSample sample;
    to_wire(status, sample);
    sample.drive_state = static_cast<std::uint8_t>(status.enabled ? DriveState::operation_enabled
                                                                  : DriveState::switch_on_disabled);
    sample.commander = controller_;
    sample.period_ns = static_cast<std::uint32_t>(diagram_.tick().count());
    std::copy(settings_.robot_name.begin(), settings_.robot_name.end(), sample.robot_name);
    sample.commands_refused = commands_.refused();
    if (controller_ != 0) sample.command_number = last_.sample.header.number;
    status_.send(sample, context_.time());
  }

  void publish() noexcept {
    const StationStatus& status = context_[station_status_];
    states_.publish({.time = context_.time(),
                     .controller = controller_,
                     .ticks = ticks_,
                     .runs = runs_,
                     .abandoned = abandoned_,
                     .received = commands_.count(Admission::admitted),
                     .refused = commands_.refused(),
                     .in_real_time = commands_.count(Admission::other_pace),
                     .enabled = status.enabled && controller_ != 0,
                     .braked = status.braked});
  }

  LockstepServerSettings settings_;
  const DdsBus& bus_;
  const Diagram& diagram_;
  Simulator simulator_;
  Context context_;
  SenderIdentity sender_;
  Slot<TorqueCommand> torque_command_;
  Slot<BrakeCommand> brake_;
  Slot<StationStatus> station_status_;

  std::uint32_t controller_ = 0;
  std::int64_t ticks_ = 0;
  std::int64_t runs_ = 0;
  std::int64_t abandoned_ = 0;
  TripleBuffer<LockstepState> states_;
  LockstepState last_state_;

  ReadingOutlet<flinch_JointSample, JointReading> joints_;
  ReadingOutlet<flinch_DriveSample, DriveReading> drives_;
  ReadingOutlet<flinch_ImuSample, ImuReading> imu_;
  ReadingOutlet<flinch_ForceTorqueSample, ForceTorqueReading> force_torque_;
  StepSender<flinch_StatusSample> status_;
  ReceivedSample<flinch_TorqueSample> last_;
  SampleSignal arrived_;
  SampleReceiver<flinch_TorqueSample> commands_;  // last: nothing arrives any more when the rest goes
};

LockstepServer::LockstepServer(const DdsBus& bus, const Diagram& diagram, const Station& station,
                               const LockstepServerSettings& settings, std::unique_ptr<Integrator> integrator)
    : implementation_(
          std::make_unique<Implementation>(bus, diagram, station, settings, std::move(integrator))) {}

LockstepServer::~LockstepServer() = default;

void LockstepServer::record(Recorder& recorder) { implementation_->record(recorder); }

void LockstepServer::run(const std::function<bool()>& over) { implementation_->run(over); }
LockstepState LockstepServer::state() { return implementation_->state(); }
std::uint64_t LockstepServer::robot_id() const noexcept { return implementation_->robot_id(); }
int LockstepServer::unreadable_commanders() const { return implementation_->unreadable_commanders(); }

}  // namespace flinch
