#include "experiments/bus/live_run.h"

#include <fmt/core.h>

#include <memory>
#include <utility>

#include "convert/legs_of_robot.h"
#include "convert/urdf_joints.h"
#include "drivers/wire_header.h"
#include "experiments/bus/await_robot.h"
#include "experiments/bus/names.h"
#include "experiments/bus/opening_monitor.h"
#include "experiments/live/spectator.h"
#include "experiments/recorded/recorded_signals.h"
#include "experiments/scenario/scenario.h"
#include "experiments/verdict/check_words.h"
#include "experiments/verdict/fault_words.h"
#include "systems/foundation/problems_of_place.h"
#include "systems/foundation/setup_error.h"
#include "systems/robot/quantity_units.h"
#include "systems/signals/sampling.h"

namespace flinch {
namespace {

/// Whether every drive is known to be so slow that the platform moves by some mm/s at most.
bool is_at_rest(const JointMotion& joints, const DriveParameters& drives) {
  return joints.rests(drives.max_speed / 400.0);
}

std::string attribute(const DurationHistogram& histogram) {
  const auto summary = histogram.summary();
  if (!summary) return "none";
  const auto us = [](Time time) { return 1e6 * to_seconds(time); };
  return fmt::format("p50 {:.0f}, p99 {:.0f}, p99.9 {:.0f}, max {:.0f} us", us(summary->p50),
                     us(summary->p99), us(summary->p99_9), us(summary->max));
}

RobotOutside outside(const LiveRunSettings& settings) {
  return settings.pace == Pace::lockstep ? RobotOutside::lockstep : RobotOutside::real;
}

std::string sent_nothing(Time patience) {
  return fmt::format("the robot has sent nothing for {:g} s", to_seconds(patience));
}

/// Nobody measures it in lockstep.
std::string round_trip_words(const DdsLink& link) {
  if (link.round_trip == Time::zero()) return "in lockstep";
  return fmt::format("round trip {:.0f} us", 1e6 * to_seconds(link.round_trip));
}

std::vector<std::string> names_of_drives(int legs) {
  std::vector<std::string> names;
  for (int leg = 1; leg <= legs; ++leg) names.push_back("drive" + std::to_string(leg));
  return names;
}

/// Those of the URDF that 'flinch export' makes of the robot; none of a robot that it cannot make one of.
ModelJoints model_joints(const Scenario& scenario) {
  try {
    const auto joints = std::make_shared<const UrdfJoints>(
        as_legs(*scenario.robot.robot, scenario.robot_text, scenario.robot_file));
    return {joints->names(), [joints](const Configuration& pose, std::vector<double>& positions) {
              return joints->find(pose, positions);
            }};
  } catch (const SetupError&) {
    return {};
  }
}

Ros2Sources shown_to_ros2(const LiveExperiment& experiment) {
  return {.joint_motion = experiment.control.joint_motion,
          .motion = experiment.control.platform_motion,
          .drive_torque = experiment.control.drive_torque,
          .imu = experiment.station.imu,
          .wrench = experiment.control.wrench_estimate,
          .gate = experiment.control.gate};
}

EventSources told_of(const LiveExperiment& experiment) {
  const ExternalStation& station = experiment.station;
  return {.detection = experiment.control.detection,
          .reaction = experiment.control.reaction_state,
          .gate = experiment.control.gate,
          .timing = experiment.tick_timing,
          .links = {station.joints_link, station.drives_link, station.imu_link, station.status_link}};
}

}  // namespace

LiveRun::LiveRun(const Scenario& scenario, const DdsBus& bus, LiveRunSettings settings)
    : scenario_(scenario),
      settings_(std::move(settings)),
      experiment_(out_of(scenario.file, [&] { return build_live_experiment(scenario, outside(settings_)); })),
      station_(bus, *experiment_.diagram, experiment_.station,
               {.robot = robot_hash(scenario.robot_text),
                .chosen_robot = settings_.chosen_robot,
                .realtime_priority = settings_.bus_priority,
                .pace = settings_.pace}),
      panel_(experiment_, scenario.control, station_, settings_.interrupts),
      ros2_(bus, *experiment_.diagram, shown_to_ros2(experiment_),
            {.joint_names = names_of_drives(scenario.robot.robot->drives()),
             .model = model_joints(scenario),
             .space = scenario.robot.robot->space(),
             .ticks_between_messages = periods_in(10ms, scenario.control_period)}),
      events_(bus, *experiment_.diagram, told_of(experiment_),
              {.robot = robot_hash(scenario.robot_text), .session = station_.session()}),
      exchange_({station_, panel_, ros2_, events_}),
      steps_(station_, settings_.patience, [this] { return settings_.interrupts() > 1; }),
      unrecorded_(*experiment_.diagram, ticks_, exchange_),
      context_(experiment_.diagram->make_context()) {
  unrecorded_.follow_clock();
  unrecorded_.feed_timing(experiment_.tick_timing);
}

LiveRun::~LiveRun() {
  if (in_lockstep()) station_.ask_for_end();  // whatever has kept end() from being called
}

void LiveRun::tick_until(Time longest, const std::function<bool()>& done) {
  unrecorded_.run(context_, context_.time() + longest, done);
}

void LiveRun::connect() {
  if (!await_robot(station_, settings_.patience, settings_.interrupts)) throw_if_undecided(station_);
  if (in_lockstep()) return begin_in_lockstep();
  fall_into_step(station_, ticks_);
  const auto sees_the_platform = [this] { return context_.get(experiment_.control.platform_motion).valid(); };
  tick_until(settings_.patience, [&] { return sees_the_platform() || is_interrupted(); });
  throw_if_interrupted(settings_.interrupts);
  if (!sees_the_platform()) throw SetupError("the platform's pose is not known: check the encoders");
  const PlatformMotion& platform = context_.get(experiment_.control.platform_motion);
  end_ = scenario_.duration + approach_from(platform.pose, scenario_);
}

/// As in simulation, where a run begins at the start of its motion.
void LiveRun::begin_in_lockstep() {
  if (!steps_.begin()) {
    throw_if_interrupted(settings_.interrupts);
    throw SetupError("the robot obeys another program, or our commands do not arrive; nothing has moved");
  }
  const Time tick = experiment_.diagram->tick();
  end_ = scenario_.duration / tick * tick;
}

void LiveRun::prepare(const std::filesystem::path& file,
                      const std::map<std::string, std::string>& provenance) {
  const Diagram& diagram = *experiment_.diagram;
  const UnitTable units = quantity_units(*scenario_.robot.robot);
  const auto attributes = recorded_attributes(scenario_, provenance);
  recorder_ = std::make_unique<Recorder>(diagram, recorded_paths(diagram), RecordingStream::ring, units);
  // Before the loop asks the machine for more than an ordinary thread gets, which writing need not have.
  stream_ = std::make_unique<RecordingStream>(*recorder_, file, attributes);
  profile_ = std::make_unique<BlockProfile>(diagram);
  TickSource* const source = in_lockstep() ? static_cast<TickSource*>(&steps_) : &ticks_;
  recorded_ = std::make_unique<RealtimeRunner>(diagram, *source, exchange_);
  recorded_->record(*recorder_);
  if (settings_.spectator != nullptr)
    recorded_->record(settings_.spectator->begin(diagram, units, attributes));
  recorded_->profile(*profile_);
  start_ = std::make_unique<Context>(diagram.make_context());
  if (in_lockstep()) return;
  recorded_->follow_clock();
  recorded_->feed_timing(experiment_.tick_timing);
  thread_ = std::make_unique<RealtimeThread>(settings_.loop);
  granted_ = thread_->report();
}

bool LiveRun::stands_ready() const {
  const DdsLink link = station_.link();
  return link.commands_obeyed && link.enabled;
}

std::string LiveRun::why_not_enabled() const {
  const DdsLink link = station_.link();
  const std::string state = std::string("the drives are in the state '") + name(link.drive_state) + "'";
  if (link.drive_state == DriveState::fault) return state + "; find out why, then use --reset-faults";
  if (!link.commands_obeyed)
    return "the robot obeys another program, or our commands do not arrive; " + state;
  return "the robot does not enable its drives; " + state;
}

void LiveRun::enable() {
  if (in_lockstep()) return;
  wish_ = {.state = RequestedDriveState::State::operation_enabled, .engage_brake = false};
  const auto faulty = [this] {
    const DdsLink link = station_.link();
    return link.commands_obeyed && link.drive_state == DriveState::fault;
  };
  const auto wait_for = [this](const std::function<bool()>& other) {
    const auto over = [&] { return stands_ready() || other() || is_interrupted(); };
    const Time deadline = context_.time() + settings_.patience;
    do {
      station_.request(
          wish_);  // a robot that heard nothing from us for some milliseconds forgets what it was asked
      tick_until(100ms, over);
    } while (!over() && context_.time() < deadline);
    throw_if_interrupted(settings_.interrupts);
  };
  wait_for(faulty);
  if (faulty() && settings_.reset_faults) {
    wish_.fault_resets = 1;
    wait_for([] { return false; });
  }
  if (!stands_ready()) throw SetupError(why_not_enabled());
}

RunStatus LiveRun::watch() {
  const LiveState& now = panel_.last();
  constexpr const char* phases[] = {"waiting", "open", "closed", "recovering"};
  const std::string fault = now.gate.passes() ? "" : description_of(now.gate.fault);
  const std::string end = settings_.attended ? "" : fmt::format(" of {:.1f}", to_seconds(end_));
  std::string said;
  if (std::exchange(refusals_told_, now.refusals.count) != now.refusals.count)
    said = fmt::format("error: {}\n", sentence(now.refusals.last));
  std::string noted;
  if (!checks_told_ && now.gate.passes()) {
    checks_told_ = true;
    for (const std::string& check : checks_off(now.askable, now.checks_drives))
      noted += "check off: " + check + "\n";
  }
  return {fmt::format("{}; gate {}{}; drives: {}", name(now.mode), phases[static_cast<int>(now.gate.phase)],
                      fault.empty() ? "" : ": " + fault, name(now.link.drive_state)),
          fmt::format("at {:.1f}{} s, force {:.0f} N, {}, lost {}, refused {}", to_seconds(now.time), end,
                      now.force, round_trip_words(now.link), now.link.lost, now.link.refused),
          {},
          said,
          noted};
}

/// By its own motion or by its brakes.
bool LiveRun::is_stopped() const {
  const GateStatus& gate = context_.get(experiment_.control.gate);
  if (gate.passes()) return false;
  return gate.reaction == GateReaction::zero_torque_and_brake ||
         is_at_rest(context_.get(experiment_.control.joint_motion), scenario_.robot.drives) ||
         !station_.link().enabled;
}

/// As at the start; also out of a fault.
void LiveRun::switch_drives_on() noexcept {
  if (station_.link().drive_state == DriveState::fault) ++wish_.fault_resets;
  station_.request(wish_);
}

void LiveRun::run() { in_lockstep() ? run_in_lockstep() : run_in_real_time(); }

void LiveRun::run_in_lockstep() {
  const std::function<bool()> over = [this] {
    stream_->wait_for_room();
    return panel_.orders().end_is_ordered() || settings_.interrupts() > 1 ||
           (is_interrupted() && is_stopped());
  };
  panel_.release_stop();
  context_ = *start_;
  recorded_->run(context_, end_, over);
  if (steps_.end() == LockstepTicks::End::silent) ended_by_ = sent_nothing(settings_.patience);
  if (steps_.end() == LockstepTicks::End::gone)
    ended_by_ = "the robot no longer waits for this program: it has given it up, or begun anew";
}

/// While the gate waits: has drives switched on again that have gone off, as where the robot has not heard us
/// for some milliseconds. Whether to end the run, since the gate will not open and nobody is there to help.
bool LiveRun::keeps_closed(OpeningMonitor& opening) {
  const Time now = context_.time();
  const bool is_given_up = opening.sees_it_closed(context_.get(experiment_.control.gate), now);
  if (settings_.attended || opening.has_opened() || is_interrupted()) return false;
  if (!stands_ready() && now - asked_again_ >= 100ms) {
    asked_again_ = now;
    station_.request(wish_);
  }
  if (is_given_up) ended_by_ = opening.sentence();
  return is_given_up;
}

void LiveRun::run_in_real_time() {
  std::uint32_t received = 0;
  Time heard{};
  OpeningMonitor opening;
  const std::function<bool()> over = [&, this] {
    if (std::exchange(received, station_.link().received) != received) heard = context_.time();
    const bool was_left = context_.time() - heard > settings_.patience;
    if (was_left) ended_by_ = sent_nothing(settings_.patience);
    const bool never_opens = keeps_closed(opening);
    if (panel_.orders().resets() && !stands_ready()) switch_drives_on();
    return was_left || never_opens || panel_.orders().end_is_ordered() || settings_.interrupts() > 1 ||
           (is_interrupted() && is_stopped());
  };
  fall_into_step(station_, ticks_);
  station_.forget_times();
  station_.request(wish_);  // again, in case that the way here took so long that the robot has given us up
  panel_.release_stop();
  context_ = *start_;
  recorded_->run(context_, settings_.attended ? Time::max() : end_, over);
}

void LiveRun::end() {
  if (in_lockstep()) return steps_.let_go();
  panel_.press_stop();
  tick_until(3s, [this] { return is_stopped() || settings_.interrupts() > 1; });
  station_.request({.state = RequestedDriveState::State::switched_on});
  tick_until(500ms, [this] { return !station_.link().enabled; });
  station_.request({.state = RequestedDriveState::State::without_voltage});
  tick_until(50ms, {});
  thread_.reset();
}

void LiveRun::finish_recording() {
  std::map<std::string, std::string> attributes;
  attributes["loop.pace"] = in_lockstep() ? "lockstep" : "real time";
  if (!in_lockstep()) note_timing(attributes);
  if (!ended_by_.empty()) attributes["run.ended"] = attributes["run.failure"] = ended_by_;
  if (panel_.orders().end_is_ordered()) attributes["run.ended"] = "by the operator, or the end of his input";
  attributes["link.refused"] = std::to_string(station_.link().refused);
  std::string blocks;
  for (const BlockProfile::Row& row : profile_->rows()) {
    blocks += fmt::format("{}: worst {:.1f} us, mean {:.2f} us\n", row.path, 1e6 * to_seconds(row.worst),
                          1e6 * to_seconds(row.total) / static_cast<double>(profile_->ticks()));
  }
  attributes["loop.blocks"] = blocks;
  stream_->finish(attributes);
}

/// How late loop and link were.
void LiveRun::note_timing(std::map<std::string, std::string>& attributes) const {
  const TickStatistics& loop = recorded_->statistics();
  const DdsLinkTimes& times = station_.times();
  attributes["loop.granted"] = granted().text();
  attributes["loop.late_starts"] = std::to_string(loop.late_starts);
  attributes["loop.overruns"] = std::to_string(loop.overruns);
  attributes["loop.lost_periods"] = std::to_string(loop.lost_periods);
  attributes["loop.lateness"] = attribute(loop.lateness);
  if (const auto lateness = loop.lateness.summary())
    attributes["loop.lateness_p99_ns"] = std::to_string(lateness->p99.count());
  attributes["loop.tick"] = attribute(loop.whole);
  attributes["link.lost"] = std::to_string(station_.link().lost);
  attributes["link.round_trip"] = attribute(times.round_trip);
  attributes["link.age"] = attribute(times.age);
}

Recording run_live_experiment(const Scenario& scenario, const DdsBus& bus, const std::filesystem::path& file,
                              const LiveRunSettings& settings,
                              const std::map<std::string, std::string>& provenance) {
  LiveRun run(scenario, bus, settings);
  run.connect();
  run.prepare(file, provenance);
  run.enable();
  run.run();
  run.end();
  run.finish_recording();
  return open_recording(file);
}

}  // namespace flinch
