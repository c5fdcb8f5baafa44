#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "drivers/dds_bus.h"
#include "drivers/pace.h"
#include "systems/framework/time.h"

namespace flinch {

/// By what the robot on the bus goes that a station with the same arguments would command: `robot` is the
/// hash of its description, `chosen_robot` its name or identity, empty where it is alone. Waits for its
/// status; none where no such robot tells it by `patience`, where more than one could be meant or one has
/// another description or protocol, or where `gives_up` says so, which is asked every 10 ms.
std::optional<Pace> find_pace(const DdsBus& bus, std::uint32_t robot, const std::string& chosen_robot,
                              Time patience, const std::function<bool()>& gives_up);

}  // namespace flinch
