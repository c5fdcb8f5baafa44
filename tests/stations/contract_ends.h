#pragma once

#include <memory>

#include "diagrams/contact_control.h"
#include "plant/simulated_station.h"
#include "systems/framework/context.h"
#include "systems/robot/planar_rrr.h"
#include "systems/robot/planar_rrr_presets.h"
#include "tests/stations/station_script.h"

/// What is the same whatever carries the readings: where they are made, and where they are used.
namespace flinch::test {

/// Readings and commands of a busy machine's link may be as old in these tests; the defaults of some
/// milliseconds have tests of their own.
inline constexpr Time longest_age = 100ms;

inline constexpr double contract_torque_constant = 6.021;  ///< of every drive here [Nm/A]

std::shared_ptr<const PlanarRrr> contract_robot();

/// The robot that readings are of.
enum class RobotKind : std::uint8_t { simulated, mock };

/// Adds a robot with injectors behind its sensors; its inputs are not connected.
struct RobotEnd {
  Station station;  ///< with the readings as they leave
  InputPort<Damage> damage;
};
RobotEnd add_robot_end(DiagramBuilder& builder, RobotKind kind);

/// Adds the pipeline, which sees the station, and the choice who commands it. The builder must be that of the
/// outermost diagram.
struct ControlEnd {
  Station station;
  ContactControl control;
  InputPort<Order> order;

  Moment see(const Context& context, Time now) const;
};
ControlEnd add_control_end(DiagramBuilder& builder, const Station& station);

}  // namespace flinch::test
