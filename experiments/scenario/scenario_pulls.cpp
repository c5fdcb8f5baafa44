#include "experiments/scenario/scenario_pulls.h"

#include <algorithm>
#include <span>
#include <string>

#include "systems/config/config_reader.h"
#include "systems/foundation/nearest_name.h"
#include "systems/robot/mechanism.h"

namespace flinch {
namespace {

InstrumentMounting read_mounting(ConfigReader& reader, const Mechanism& robot) {
  InstrumentMounting mounting;
  std::string name;
  reader.required().text("body", name);
  std::vector<std::string> known;
  for (const Body& body : robot.description().bodies) known.push_back(body.name);
  const auto found = std::find(known.begin(), known.end(), name);
  if (found == known.end()) {
    reader.problem("body", "is '" + name + "', which is no body of this robot" + did_you_mean(name, known));
  } else {
    mounting.body = static_cast<int>(found - known.begin());
  }
  const auto directions = static_cast<std::size_t>(robot.space_dimension());
  reader.required().numbers("position", unit::m,
                            std::span<double>(mounting.position_in_body.data(), directions));
  reader.required().duration("start", mounting.start, not_negative);
  reader.duration("slack", mounting.slack, between(0.1, 60.0));
  return mounting;
}

}  // namespace

std::vector<InstrumentMounting> read_mountings(ConfigReader& scenario, const Mechanism& robot) {
  std::vector<InstrumentMounting> mountings;
  for (ConfigReader& reader : scenario.sections("pulls")) {
    mountings.push_back(read_mounting(reader, robot));
    if (mountings.size() > 1 && mountings.back().start <= mountings[mountings.size() - 2].start) {
      reader.problem("start", "is not after that of the entry before it");
    }
  }
  return mountings;
}

}  // namespace flinch
