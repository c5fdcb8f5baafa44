#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>

#include "experiments/bus/operator_panel.h"
#include "experiments/bus/tidings.h"
#include "experiments/live/live_experiment.h"
#include "systems/framework/block_profile.h"
#include "systems/framework/realtime_runner.h"
#include "systems/framework/realtime_thread.h"
#include "systems/framework/recorder.h"

namespace flinch {

struct Scenario;

/// What a run needs of the world outside.
struct LiveLink {
  DdsStation& station;
  OperatorPanel& panel;
  Exchange& exchange;  ///< of all that talks with the diagram, station and panel among them
};

/// A scenario against a robot on the bus. To be called in this order, on one thread: connect(),
/// prepare(), enable(), run(), end(). The first three throw SetupError where the robot does not answer, or
/// not as it should, within `patience`, or where somebody interrupts; end() may follow any of them.
class LiveRun {
 public:
  LiveRun(const Scenario& scenario, const LiveExperiment& experiment, const LiveLink& link, Time patience);

  /// Waits for readings that this program understands, and finds out where the platform is. Commands no
  /// torque and closed brakes, by which it takes the robot: nobody else can command it from then on.
  void connect();

  /// Makes ready all that the run needs, so that later nothing has to be allocated.
  void prepare(const RealtimeSettings& settings);
  /// What the machine has granted.
  const RealtimeReport& granted() const { return granted_; }

  /// Switches the drives on, and if wanted resets their faults first. The brakes stay closed: the stop button
  /// is down until run().
  void enable(bool reset_faults);

  /// The scenario from its start, recorded; ends when it is over or, after an interrupt has stopped the
  /// robot, when that rests; at the second interrupt at once.
  void run();

  /// Brings the robot to rest, closes the brakes, switches the drives off. What does not happen in time is
  /// left: the silence that follows lets the other end brake.
  void end();

  /// For a StatusLine around run() and end(): how the run is.
  Tidings watch();

  /// What was recorded, with what is known of loop and link as attributes.
  Recording recording(std::map<std::string, std::string> attributes) const;
  const TickStatistics& statistics() const { return recorded_->statistics(); }

 private:
  void tick_until(Time longest, const std::function<bool()>& done);
  bool stands_ready() const;
  bool is_stopped() const;
  std::string why_not_enabled() const;

  const Scenario& scenario_;
  const LiveExperiment& experiment_;
  LiveLink link_;
  Time patience_;
  ClockTicks ticks_;
  RealtimeRunner unrecorded_;
  Context context_;
  std::unique_ptr<Recorder> recorder_;
  std::unique_ptr<BlockProfile> profile_;
  std::unique_ptr<RealtimeRunner> recorded_;
  std::unique_ptr<Context> start_;
  DriveWish wish_;
  std::unique_ptr<RealtimeThread> thread_;
  RealtimeReport granted_;
  Time end_{};
};

}  // namespace flinch
