#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "diagrams/station.h"
#include "drivers/dds_bus.h"
#include "systems/framework/context.h"
#include "systems/framework/integrator.h"

namespace flinch {

class Recorder;

struct LockstepServerSettings {
  /// The robot_hash() of the robot description: that of the other end, or nothing passes.
  std::uint32_t robot = 0;
  /// That a user gives the robot, to choose it by among several on one bus; see problems_of_robot_name().
  std::string robot_name = {};
  /// By the wall clock, with a controller that sends nothing: then the next one is waited for.
  Time patience = 10s;
};

/// How it goes, since the start.
struct LockstepState {
  Time time{};                     ///< of the simulation, in the present run
  std::uint32_t controller = 0;    ///< session that the robot waits for; 0: none
  std::int64_t ticks = 0;          ///< of all runs
  std::int64_t runs = 0;           ///< that have begun
  std::int64_t abandoned = 0;      ///< controllers that sent nothing for as long as the patience
  std::uint32_t received = 0;      ///< commands that were admitted
  std::uint32_t refused = 0;       ///< of another version, robot, session or pace, or not newer
  std::uint32_t in_real_time = 0;  ///< of these: from controllers that go by the clock
  bool enabled = false;            ///< the drives act on torques
  bool braked = false;             ///< the brakes are closed
};

/// Puts a simulated station on the bus that waits for its controller: it moves on by one tick when the
/// command for that tick has come, and so on any machine, under any load, as it does in one program with the
/// controller. No clock takes part; the stamps of all samples are times of the simulation.
///
///   x := the start
///   wait for a controller, which asks for a begin with a command of no torque or with brakes
///   for k = 0, 1, 2, ...
///     send the readings at t_k, which depend on x alone, every 20 ms of the wall clock until
///     the command for t_k has come; or an end, or nothing for as long as the patience: to the start
///     x := what follows from it, at t_{k+1}
///
/// A controller that begins anew finds the robot at its start. Only something simulated can stand still and
/// go back; so this takes the diagram and moves it itself, and a driver program for real drives has no way to
/// do the same: DdsServer refuses every sample of an end in lockstep.
class LockstepServer {
 public:
  /// The inputs `torque_command` and `brake` of `station` are those of the outermost diagram, and its outputs
  /// follow from its states without them. Throws SetupError.
  LockstepServer(const DdsBus& bus, const Diagram& diagram, const Station& station,
                 const LockstepServerSettings& settings, std::unique_ptr<Integrator> integrator = nullptr);
  ~LockstepServer();

  /// Lets `recorder` see every tick; its time begins anew with each run. Before run().
  void record(Recorder& recorder);
  /// Until `over`, which is asked at least every 20 ms.
  void run(const std::function<bool()>& over);

  /// The last state, for one thread.
  LockstepState state();
  /// See draw_robot_id().
  std::uint64_t robot_id() const noexcept;
  /// How many programs command in another protocol, so that nothing of it arrives. Not in run()'s thread.
  int unreadable_commanders() const;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace flinch
