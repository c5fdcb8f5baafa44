#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "convert/body_graph.h"
#include "convert/chain_motion.h"
#include "convert/closed_chains.h"
#include "systems/robot/legs/legs_parameters.h"

namespace flinch {

/// What a model does not say.
struct ConversionSettings {
  std::string platform = {};                 ///< Link or frame that becomes E.
  std::vector<std::string> drives = {};      ///< Joints; empty: as the model says.
  std::map<std::string, double> guess = {};  ///< About where joints are at home [rad or m].
  std::vector<std::string> massless = {};    ///< Links whose mass is no mass of the robot, such as markers.
};

/// A model as a robot of kind `legs`.
struct Conversion {
  BodyGraph graph;  ///< Without joints that do not move.
  ClosedChains chains;
  ChainState home;
  Eigen::Matrix3d base_axes;  ///< Of flinch's base frame, as columns in those of the model's base.
  LegsParameters robot;
  double max_effort = 0.0;         ///< Of the drives [Nm or N]; 0: the default.
  std::vector<std::string> notes;  ///< What one should know, one sentence each.
};

/// The links and joints of a model in URDF, SDF or MJCF. Throws SetupError with file and line.
BodyGraph read_model(std::string_view text, const std::string& file);

/// The robot that `graph` describes. Throws SetupError with what makes it none that flinch can run: the link
/// or joint, why, and the way out.
Conversion converted_robot(BodyGraph graph, const ConversionSettings& settings);

/// The robot file.
std::string robot_text(const Conversion& conversion);

}  // namespace flinch
