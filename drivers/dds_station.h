#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "diagrams/external_station.h"
#include "drivers/dds_bus.h"
#include "drivers/drive_state.h"
#include "drivers/pace.h"
#include "drivers/requested_drive_state.h"
#include "drivers/robot_id.h"
#include "systems/framework/context.h"
#include "systems/framework/duration_histogram.h"
#include "systems/framework/exchange.h"

namespace flinch {

struct DdsStationSettings {
  /// The robot_hash() of the robot description: that of the other end, or nothing passes.
  std::uint32_t robot = 0;
  /// Name or identity of the robot to command; empty: the only one that is there. Where several are, or two
  /// have the chosen name, none is commanded.
  std::string chosen_robot = {};
  Time longest_silence = 100ms;  ///< after which another sender of readings is accepted
  int realtime_priority = 0;     ///< of the thread that sends, SCHED_FIFO, 1 to 99; 0: an ordinary thread
  Pace pace = Pace::real_time;   ///< that the robot must have, too
};

/// How the link has been since the start.
struct DdsLink {
  std::uint32_t received = 0;  ///< joint samples
  /// Samples of any kind: another protocol version, description or sender, or old.
  std::uint32_t refused = 0;
  std::uint32_t other_version = 0;      ///< of these
  std::uint32_t other_description = 0;  ///< likewise
  std::uint32_t other_pace = 0;         ///< likewise: of the robot to command, which goes by another pace
  std::uint32_t other_robot = 0;        ///< besides: of robots that this station does not command
  std::uint64_t robot_id = 0;           ///< of the robot that is commanded; 0: none yet
  int robots = 0;                       ///< that were seen
  Time period{};                        ///< from tick to tick at the other end; zero: not told yet
  std::uint32_t lost = 0;               ///< joint samples that never came, by their numbers
  std::uint32_t deadlines_missed = 0;   ///< periods of 5 ms without joint samples
  bool enabled = false;                 ///< by the last status
  DriveState drive_state = DriveState::not_ready_to_switch_on;  ///< likewise
  bool commands_obeyed = false;                                 ///< the other end obeys this session
  Time round_trip{};  ///< of the last echoed command, without the time that the other end kept it; in
                      ///< lockstep zero: nobody measures it
};

/// How long things took on the link, one count a tick that found something new. Never allocates.
struct DdsLinkTimes {
  DurationHistogram round_trip;  ///< of an echoed command, without the time that the other end kept it
  DurationHistogram age;         ///< of joint readings when their tick started, by their acquisition
  DurationHistogram interval;    ///< between arrivals of joint readings
};

/// Carries an ExternalStation's readings from the bus and its commands to it. Receiving and sending happen on
/// other threads; what is called from the loop neither blocks, allocates nor throws.
///
/// A reading's stamp of acquisition is translated twice: from the sender's monotonic clock to ours by the
/// smallest delay seen (ClockMap), and to the time of the ticks by the most punctual tick (TickClock). It is
/// late by the smallest delay on the way. No wall clock takes part. A context whose time is earlier than that
/// of the last tick begins a new run on the same link. Drives that obey somebody else are not enabled for
/// this diagram.
///
/// It commands one robot. It looks 300 ms for those that are there, and takes the only one, or the chosen
/// one, for good; another one that appears later is not heard, and a robot whose program starts anew is
/// another one. Every command names the robot, and no other obeys it. Until then nothing is sent.
///
/// In lockstep it commands a robot that waits for it (LockstepServer). Then the diagram runs with
/// LockstepTicks, stamps are times of the simulation at both ends and stay as they are, and commands are sent
/// from the thread of the loop, which has nothing else to do until the robot answers.
class DdsStation final : public Exchange {
 public:
  /// `diagram` is the one to run, with the inputs of `station`. Throws SetupError.
  DdsStation(const DdsBus& bus, const Diagram& diagram, const ExternalStation& station,
             const DdsStationSettings& settings);
  ~DdsStation() override;

  /// Sets the station's readings to what has arrived.
  void set_inputs(Context& context) override;
  /// From tick to tick of the diagram.
  Time period() const noexcept;
  /// As the settings say.
  Pace pace() const noexcept;
  /// Hands torque command and brake to the bus.
  void take_outputs(const Context& context) override;

  /// Blocks until the next joint readings arrive, or until MonotonicClock::now() reaches `deadline`; returns
  /// whether they have. Of the loop's thread, between runs: to bring ticks into step with the readings. The
  /// other readings of the same tick were sent before.
  bool wait_for_joints(Time deadline) noexcept;

  /// Sends one command of no torque with closed brakes, so that a robot which refuses this program knows of
  /// it. Between runs.
  void introduce() noexcept;

  /// What became of waiting, in lockstep.
  enum class Answer : std::uint8_t {
    none,   ///< not yet
    ready,  ///< the readings of the tick have come
    gone,   ///< the robot no longer waits for this program: it has given it up, or begun anew
  };
  /// In lockstep: asks the robot to stand at its start and to wait for the command of the first tick. Again
  /// and again, with wait_for_tick() in between, until that says that the readings of this tick have come.
  void ask_for_begin() noexcept;
  /// In lockstep: waits until the readings of the next tick have come, or until MonotonicClock::now() reaches
  /// `deadline`. Of the loop's thread.
  Answer wait_for_tick(Time deadline) noexcept;
  /// In lockstep: sends what the robot has not answered once more.
  void send_again() noexcept;
  /// In lockstep: lets the robot go, so that it waits for the next controller.
  void ask_for_end() noexcept;

  /// Asks for a state of the drives, until the next call. From one thread at a time, not from the loop. In
  /// lockstep nothing: the drives are on.
  void request(const RequestedDriveState& wish) noexcept;

  /// Of the thread that calls set_inputs(), or while it does not.
  DdsLink link() const noexcept;
  /// The robots that were seen. It allocates: not in the loop.
  std::vector<SeenRobot> robots() const;
  /// The robot to command, which is taken now if it is time to; 0: none yet.
  std::uint64_t take_robot() noexcept;
  /// Whether several robots could be meant, so that none is commanded.
  bool is_undecided() const noexcept;
  /// How many others send joint readings. It asks the bus: from any thread but that of the loop.
  int peers() const noexcept;
  /// How many more send them in another protocol, so that none arrives. Likewise.
  int unreadable_robots() const;
  /// Of the thread that calls set_inputs(), or while it does not.
  const DdsLinkTimes& times() const noexcept;
  /// Begins them anew. Likewise.
  void forget_times() noexcept;
  /// The session under which commands are sent.
  std::uint32_t session() const noexcept;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace flinch
