#pragma once

#include <fstream>
#include <sstream>
#include <string>

#include "convert/closure_list.h"
#include "convert/conversion.h"
#include "systems/config/legs_file.h"
#include "systems/config/legs_text.h"
#include "systems/robot/legs/legs_robot.h"

/// Models of tests/convert/models, and what becomes of them.
namespace flinch::test {

inline std::string model_text(const std::string& name) {
  std::ifstream stream("tests/convert/models/" + name);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

inline BodyGraph model(const std::string& name) { return read_model(model_text(name), name); }

inline BodyGraph five_bar() {
  BodyGraph graph = model("five_bar.urdf");
  add_closures(model_text("five_bar_closures.yaml"), "five_bar_closures.yaml", graph);
  return graph;
}

/// What a robot file says, read as flinch reads it.
inline LegsParameters read_again(const std::string& text) {
  ConfigReader reader = ConfigReader::parse(text, "robot.yaml");
  return read_legs_parameters(reader);
}

}  // namespace flinch::test
