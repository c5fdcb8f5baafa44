#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "systems/framework/time.h"
#include "systems/robot/parallel_robot.h"

namespace flinch {

/// What a fault touches that somebody asks for, to see how a robot answers.
enum class FaultSignal : std::uint8_t {
  encoder,          ///< of a drive
  passive_encoder,  ///< of a passive joint
  current,          ///< what is measured of a motor's current
  gyroscope,
  accelerometer,
  imu,  ///< both
  force_torque,
  status,  ///< what the station says of itself
  drive,   ///< what a motor does
  brake,
  link,  ///< every sample between station and control path, either way
};

/// What is wrong with it, from its begin on.
enum class FaultKind : std::uint8_t {
  off,           ///< no data; of a drive no torque; of a brake: it does not hold
  stuck,         ///< stays as it is, under fresh stamps; of a brake: closed
  noise,         ///< white noise of standard deviation `size` on top
  wrong,         ///< `size` more
  drifting,      ///< `size` a second more
  scaled,        ///< `size` times what it should be; of an encoder: of the way since
  delayed,       ///< what was true `size` seconds before, under fresh stamps; of the link under true ones
  intermittent,  ///< off in a share `size` of all ticks
  reversed,      ///< with the other sign; an encoder counts the other way
  saturated,     ///< no further from zero than `size`
  turned,        ///< the sensor is, about an axis of its own, all of them alike without a number [rad]
};

/// A fault on request.
struct RequestedFault {
  FaultSignal signal = FaultSignal::encoder;
  std::optional<int> index{};  ///< of the encoder, drive, axis, from 0; none: all
  FaultKind kind = FaultKind::off;
  Time begin{};
  /// As `kind` says, in SI units. What is stuck may have noise of it; a drive may be stuck at it [Nm or N].
  std::optional<double> size{};
};

/// The longest delay that readings and commands can be given.
inline constexpr Time longest_delay = 60ms;

/// All that is wrong with a fault of a robot: what it has not got, what cannot happen to it, or a size that
/// is missing, meaningless or out of range.
std::vector<std::string> problems(const RequestedFault& fault, const ParallelRobot& robot);

/// Where faults are made.
struct FaultPlace {
  bool moves = true;  ///< As a recording does not: drives and brakes have no effect on it.
  bool has_passive_encoders = true;
  bool has_force_torque = true;
  Time end = Time::max();  ///< Of the run.
};
/// What of it cannot happen there, or would never show.
std::vector<std::string> problems(const RequestedFault& fault, const FaultPlace& place);
/// Throws SetupError with all of that.
void require_possible(const std::vector<RequestedFault>& faults, const FaultPlace& place);

/// The signal with its number, from 1 on, and the kind, as users write them: "encoder2", "drives", "off".
/// Throws SetupError with the nearest name where there is none called so.
void set_signal(RequestedFault& fault, const std::string& text);
FaultKind fault_kind(const std::string& text);
/// The words that it understands.
std::vector<std::string> fault_kinds();

/// Reads "SIGNAL:KIND@TIME[:SIZE]", such as "encoder2:drifting@0.5:-5"; TIME in seconds. Throws SetupError
/// with all that is wrong with it, for `robot` too.
RequestedFault parse_fault(const std::string& text, const ParallelRobot& robot);

/// What parse_fault() reads.
std::string text_of(const RequestedFault& fault);

}  // namespace flinch
