#include "experiments/recorded/robot_as_drawn.h"

#include <nlohmann/json.hpp>

#include "systems/foundation/json_text.h"
#include "systems/foundation/setup_error.h"
#include "systems/framework/recording.h"

namespace flinch {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* attribute = "robot.drawn.text";

}  // namespace

void note_robot(const DrawnValues& values, std::map<std::string, std::string>& attributes) {
  if (values.empty()) return;
  Json json = Json::object();
  for (const auto& [key, numbers] : values) json[key] = numbers;
  attributes[attribute] = json_text(json);
}

DrawnValues robot_as_drawn(const Recording& recording) {
  const auto found = recording.attributes.find(attribute);
  if (found == recording.attributes.end()) return {};
  DrawnValues values;
  try {
    const Json json = Json::parse(found->second);
    for (const auto& [key, numbers] : json.items()) {
      values.emplace_back(key, numbers.get<std::vector<double>>());
    }
  } catch (const Json::exception& error) {
    throw SetupError("the attribute '" + std::string(attribute) +
                     "' does not hold what 'flinch run' writes there: " + error.what());
  }
  return values;
}

}  // namespace flinch
