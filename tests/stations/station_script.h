#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "systems/framework/recording.h"
#include "systems/framework/time.h"
#include "systems/signals/brake_command.h"
#include "systems/signals/drive_reading.h"
#include "systems/signals/gate_fault.h"
#include "systems/signals/gate_status.h"
#include "systems/signals/imu_reading.h"
#include "systems/signals/joint_reading.h"
#include "systems/signals/station_status.h"
#include "systems/signals/torque_command.h"

/// What a test has happen at a station, and what came of it.
namespace flinch::test {

enum class Source : std::uint8_t { nothing, joints, drives, imu, status };
enum class Harm : std::uint8_t { lost, stale, not_a_number, jump, frozen };

/// What is wrong with one of the readings where it is made.
struct Damage {
  Source source = Source::nothing;
  Harm harm = Harm::lost;
};

/// Who commands: the pipeline, or the test with these commands.
struct Order {
  bool by_test = false;
  TorqueCommand torque{};  ///< `computed` is set by the age
  Time age{};              ///< of the command when the station sees it
  BrakeCommand brake{.engage = true};
};

/// At each time since the start.
struct Script {
  Time duration = 200ms;
  std::function<Order(Time)> order = [](Time) { return Order{}; };
  std::function<Damage(Time)> damage = [](Time) { return Damage{}; };
  std::optional<Time> robot_restarts{};       ///< for stations outside this program
  std::optional<Time> controller_restarts{};  ///< the same
  std::optional<Order> replay_order{};        ///< for recorded stations: commanded throughout while they play
};

/// What was there at a tick.
struct Moment {
  Time now{};
  JointReading joints;
  DriveReading drives;
  ImuReading imu;
  StationStatus status;
  FaultMask faults = 0;  ///< that the pipeline found
  GateStatus gate;       ///< of the pipeline
};

using Trace = std::vector<Moment>;

/// What a station did.
struct StationRun {
  std::vector<std::string> inputs;  ///< of the contract
  std::vector<Signal> outputs;      ///< of the contract, without rows: names and fields
  Trace before;                     ///< ticks before the script, while the station waits for readings
  Trace trace;                      ///< of the script
};

}  // namespace flinch::test
