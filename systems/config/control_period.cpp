#include "systems/config/control_period.h"

#include "systems/config/config_reader.h"

namespace flinch {
namespace {

constexpr double seconds(std::chrono::nanoseconds time) {
  return std::chrono::duration<double>(time).count();
}

}  // namespace

void read_control_period(ConfigReader& reader, std::chrono::nanoseconds& period) {
  reader.duration("control_period", period,
                  between(seconds(shortest_control_period), seconds(longest_control_period)));
}

}  // namespace flinch
