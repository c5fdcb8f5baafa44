#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>

#include "drivers/bus_settings.h"
#include "drivers/dds_station.h"
#include "drivers/event_publisher.h"
#include "drivers/lockstep_ticks.h"
#include "drivers/ros2_publisher.h"
#include "experiments/bus/interrupt_count.h"
#include "experiments/bus/operator_panel.h"
#include "experiments/bus/run_status.h"
#include "experiments/live/live_experiment.h"
#include "systems/framework/block_profile.h"
#include "systems/framework/exchange_list.h"
#include "systems/framework/realtime_runner.h"
#include "systems/framework/realtime_thread.h"
#include "systems/framework/recorder.h"
#include "systems/framework/recording_stream.h"

namespace flinch {

class OpeningMonitor;
class Spectator;
struct Scenario;

struct LiveRunSettings {
  Pace pace = Pace::real_time;    ///< that the robot must have, too
  Time patience = 10s;            ///< with a robot that does not answer, is not enabled, or falls silent
  std::string chosen_robot = {};  ///< among several; see DdsStationSettings
  bool reset_faults = false;      ///< of the drives, before the run
  bool attended = false;          ///< runs until an operator orders its end, not for the scenario's duration
  int bus_priority = 0;           ///< SCHED_FIFO of the thread that receives, where permitted; 0: ordinary
  RealtimeSettings loop = {};     ///< what the loop's thread asks the machine for
  InterruptCount interrupts = no_interrupts;
  Spectator* spectator = nullptr;  ///< who sees the run and does not say how fast it is; null: nobody
};

/// A scenario against a robot on the bus. In lockstep with a simulated one it is, bit for bit, what it is in
/// one program with that: the run begins with the robot at its start.
///
/// To be called in this order, on one thread: connect(), prepare(), enable(), run(), end(). The first three
/// throw SetupError where the robot does not answer, or not as it should, within the patience, or where
/// somebody interrupts; end() may follow any of them. What happens is told on the bus: events and
/// diagnostics, and topics for tools of ROS 2.
class LiveRun {
 public:
  /// `scenario` and `bus` must outlive this. Throws SetupError for settings that do not fit together.
  LiveRun(const Scenario& scenario, const DdsBus& bus, LiveRunSettings settings);
  LiveRun(const LiveRun&) = delete;
  LiveRun& operator=(const LiveRun&) = delete;
  ~LiveRun();

  /// Waits for readings that this program understands, and finds out where the platform is. Commands no
  /// torque and closed brakes, by which it takes the robot: nobody else can command it from then on.
  void connect();

  /// Makes ready all that the run needs, so that later nothing has to be allocated. The run will be recorded
  /// into `file`, with `provenance` among the attributes.
  void prepare(const std::filesystem::path& file, const std::map<std::string, std::string>& provenance);
  /// What the machine has granted.
  const RealtimeReport& granted() const { return granted_; }

  /// Switches the drives on, and if wanted resets their faults first. The brakes stay closed: the stop button
  /// is down until run().
  void enable();

  /// Why the run ended before its time: the robot had been silent for longer than the patience, no longer
  /// waited for this program, or the torque gate did not open; "" where it did not.
  const std::string& ended_by() const { return ended_by_; }

  /// The scenario from its start, recorded; ends when it is over or, after an interrupt has stopped the
  /// robot, when that rests; at the second interrupt at once.
  void run();

  /// Gives an operator's order to run(), attended or not. A reset also switches drives on that have gone off,
  /// and resets their faults; they are on some ticks later, and the gate takes another reset then. watch()
  /// says which were refused. For one other thread. False, and not followed, where too many wait.
  bool give(const OperatorOrder& order) noexcept { return panel_.orders().give(order); }

  /// Brings the robot to rest, closes the brakes, switches the drives off. What does not happen in time is
  /// left: the silence that follows lets the other end brake.
  void end();

  /// How the run is. For one other thread, during run() and end().
  RunStatus watch();

  /// Makes the recording whole, with what is known of loop and link as attributes. Throws SetupError where
  /// it could not be written.
  void finish_recording();
  const TickStatistics& statistics() const { return recorded_->statistics(); }
  const DdsStation& station() const { return station_; }

 private:
  void tick_until(Time longest, const std::function<bool()>& done);
  void begin_in_lockstep();
  void run_in_lockstep();
  void note_timing(std::map<std::string, std::string>& attributes) const;
  void run_in_real_time();
  bool keeps_closed(OpeningMonitor& opening);
  bool in_lockstep() const { return settings_.pace == Pace::lockstep; }
  bool is_interrupted() const { return settings_.interrupts() > 0; }
  bool stands_ready() const;
  void switch_drives_on() noexcept;
  bool is_stopped() const;
  std::string why_not_enabled() const;

  const Scenario& scenario_;
  LiveRunSettings settings_;
  LiveExperiment experiment_;
  DdsStation station_;
  OperatorPanel panel_;
  Ros2Publisher ros2_;
  EventPublisher events_;
  ExchangeList exchange_;
  ClockTicks ticks_;
  LockstepTicks steps_;
  RealtimeRunner unrecorded_;
  Context context_;
  std::unique_ptr<Recorder> recorder_;
  std::unique_ptr<RecordingStream> stream_;
  std::unique_ptr<BlockProfile> profile_;
  std::unique_ptr<RealtimeRunner> recorded_;
  std::unique_ptr<Context> start_;
  RequestedDriveState wish_;
  std::string ended_by_;
  Time asked_again_{};  ///< for the drives, in the time of the run
  std::uint32_t refusals_told_ = 0;
  bool checks_told_ = false;
  std::unique_ptr<RealtimeThread> thread_;
  RealtimeReport granted_;
  Time end_{};
};

/// The whole of such a run, recorded into `file`; what it returns reads from there. `provenance` becomes part
/// of the attributes. Throws SetupError where it could not begin: then nothing has moved.
Recording run_live_experiment(const Scenario& scenario, const DdsBus& bus, const std::filesystem::path& file,
                              const LiveRunSettings& settings = {},
                              const std::map<std::string, std::string>& provenance = {});

}  // namespace flinch
