#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <string>

#include "diagrams/station.h"
#include "drivers/dds_bus.h"
#include "drivers/powered_station.h"
#include "systems/framework/context.h"
#include "systems/framework/exchange.h"

namespace flinch {

struct DdsServerSettings {
  /// The robot_hash() of the robot description: that of the other end, or nothing passes.
  std::uint32_t robot = 0;
  /// Without a newer command: the brakes close, and who commanded must begin anew. With the rig's tick and
  /// the 10 ms in which the brakes must be commanded to close this leaves room for a busy machine.
  Time longest_silence = 6ms;
  /// The same for ticks of `period`: of long ones, one command may be missing.
  static constexpr Time longest_silence_at(Time period) { return std::max<Time>(6ms, 5 * period / 2); }
  /// Of a command from sending to arrival, as far as it varies; later ones are refused.
  Time longest_way = 5ms;
  /// That a user gives the robot, to choose it by among several on one bus; see problems_of_robot_name().
  std::string robot_name = {};
  int realtime_priority = 0;  ///< of the thread that sends, SCHED_FIFO, 1 to 99; 0: an ordinary thread
};

/// Who commands, since the start.
struct DdsCommander {
  std::uint32_t session = 0;  ///< whose commands are obeyed; 0: nobody's
  std::uint32_t received = 0;
  /// Of another version, robot or session, not newer, too late, or not neutral at first.
  std::uint32_t refused = 0;
  std::uint32_t for_others = 0;   ///< of these: meant for another robot
  std::uint32_t in_lockstep = 0;  ///< likewise: of controllers that wait for their robot
  std::uint32_t silences = 0;     ///< how often a commander fell silent
  Time age{};                     ///< of the last command, by its sending
};

/// Puts a station on the bus: sends its readings after each tick, and lets commands in before. It has an
/// identity of its own, drawn at its start, and hears only commands that name it. Of these it obeys one
/// session at a time, which begins with a command of no torque or with brakes, in time and in order; to all
/// others, and when the session falls silent, the answer is no torque and closed brakes; once it has obeyed
/// another, it does not listen to that session again. A station on the
/// bus says that it is enabled only while it obeys somebody. A drive request of that session for brakes, or
/// for less than operation, closes the brakes whatever its torque commands say. It also says what the drives
/// shall be, where the station's drives must be switched on; while nobody is obeyed, without voltage.
///
/// Receiving and sending happen on other threads; what is called from the loop neither blocks, allocates nor
/// throws. `torque_command`, `brake` and `wish` must be inputs of the outermost diagram.
class DdsServer final : public Exchange {
 public:
  /// Throws SetupError.
  DdsServer(const DdsBus& bus, const Diagram& diagram, const PoweredStation& station,
            const DdsServerSettings& settings);
  /// For a station whose drives are always on. Throws SetupError.
  DdsServer(const DdsBus& bus, const Diagram& diagram, const Station& station,
            const DdsServerSettings& settings);
  ~DdsServer() override;

  /// Sets torque command and brake.
  void set_inputs(Context& context) override;
  /// Sends the readings.
  void take_outputs(const Context& context) override;

  /// As the last set_inputs() saw it; of the thread that calls that, or while it does not.
  DdsCommander commander() const noexcept;
  /// How many programs command in another protocol, so that nothing of it arrives. Not in the loop.
  int unreadable_commanders() const;
  /// See draw_robot_id().
  std::uint64_t robot_id() const noexcept;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace flinch
