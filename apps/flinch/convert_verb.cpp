// flinch convert: a robot file out of a model of another tool.
#include <algorithm>
#include <charconv>
#include <nlohmann/json.hpp>
#include <numbers>

#include "apps/flinch/output_place.h"
#include "apps/flinch/printing.h"
#include "apps/flinch/verbs.h"
#include "convert/closure_list.h"
#include "convert/conversion.h"
#include "systems/config/config_file.h"
#include "systems/config/robot_file.h"
#include "systems/foundation/json_text.h"
#include "systems/foundation/nearest_name.h"
#include "systems/foundation/result_file.h"
#include "systems/foundation/setup_error.h"

namespace flinch {
namespace {

using Json = nlohmann::ordered_json;

/// JOINT=NUMBER, degrees of a joint that turns, mm of one that slides.
std::pair<std::string, double> guess_of(const std::string& text, const BodyGraph& graph) {
  const std::size_t sign = text.rfind('=');
  double number = 0.0;
  if (sign != std::string::npos) {
    const char* const end = text.data() + text.size();
    const auto [rest, error] = std::from_chars(text.data() + sign + 1, end, number);
    if (error == std::errc() && rest == end && std::abs(number) < 1e6) {
      const std::string joint = text.substr(0, sign);
      const bool slides = graph.joints[graph.joint(joint)].kind == GraphJoint::Kind::prismatic;
      return {joint, number * (slides ? 1e-3 : std::numbers::pi / 180.0)};
    }
  }
  throw SetupError("--guess: is '" + text +
                   "'; it must be JOINT=NUMBER, in degrees, or mm of a joint that slides");
}

ConversionSettings settings_of(const ConvertOptions& options, const BodyGraph& graph) {
  ConversionSettings settings;
  settings.platform = options.platform;
  settings.drives = options.drives;
  settings.massless = options.massless;
  for (const std::string& guess : options.guess) settings.guess.insert(guess_of(guess, graph));
  return settings;
}

std::vector<std::string> drives_of(const LegsParameters& robot) {
  std::vector<std::string> names;
  for (const RobotLeg& leg : robot.legs) {
    for (const LegJoint& joint : leg.joints) {
      if (joint.drive) names.push_back(joint.name);
    }
  }
  return names;
}

double mass_of(const LegsParameters& robot) {
  double mass = robot.platform.inertia.mass;
  for (const RobotLeg& leg : robot.legs) {
    for (const LegJoint& joint : leg.joints) mass += joint.link ? joint.link->inertia.mass : 0.0;
  }
  return mass;
}

std::string moves_text(const PlatformMoves& moves) {
  std::vector<std::string> free, following;
  for (std::size_t i = 0; i < chart_names.size(); ++i) {
    if (moves.roles[i] == ChartRole::free) free.emplace_back(chart_names[i]);
    if (moves.roles[i] == ChartRole::follows) following.emplace_back(chart_names[i]);
  }
  return listed(free) + (following.empty() ? "" : "; " + listed(following) + " follow");
}

void tell(const Conversion& conversion, const ConvertOptions& options) {
  const LegsParameters& robot = conversion.robot;
  const std::vector<std::string> drives = drives_of(robot);
  if (options.common.json) {
    print_result("{}\n", json_text(Json{{"robot", options.out.string()},
                                        {"name", robot.name},
                                        {"legs", robot.legs.size()},
                                        {"drives", drives},
                                        {"moves", moves_text(robot.moves)},
                                        {"moving_mass_kg", mass_of(robot)},
                                        {"notes", conversion.notes}}));
    return;
  }
  for (const std::string& note : conversion.notes) print_message("note: {}\n", note);
  if (options.common.quiet) return;
  print_result("{}: {}, {} legs, drives {}, moves in {}, {:.4g} kg that move\n", options.out.string(),
               robot.name, robot.legs.size(), listed(drives), moves_text(robot.moves), mass_of(robot));
}

}  // namespace

ExitStatus convert_model(const ConvertOptions& options) {
  std::vector<std::filesystem::path> inputs{options.model};
  if (!options.closures.empty()) inputs.push_back(options.closures);
  require_output(options.out, inputs, OutputKind::robot);
  BodyGraph graph = read_model(read_config_file(options.model), options.model.string());
  if (!options.closures.empty())
    add_closures(read_config_file(options.closures), options.closures.string(), graph);
  const ConversionSettings settings = settings_of(options, graph);
  const Conversion conversion = converted_robot(std::move(graph), settings);
  const std::string text = robot_text(conversion);
  parse_robot_file(text, options.out.string());  // as whoever uses it will
  write_result(options.out, text);
  tell(conversion, options);
  return ExitStatus::done;
}

void add_convert_verb(CLI::App& app, Verbs& verbs) {
  ConvertOptions& options = verbs.convert;
  CLI::App& verb =
      verbs.add(app, "convert", "Make a robot file out of a model: URDF, SDF or MJCF",
                "flinch convert robot.urdf --closures robot.yaml --platform effector --out robot_file.yaml",
                options, &convert_model);
  verb.add_option("model", options.model, "The model; of xacro what it writes")
      ->required()
      ->type_name("MODEL");
  verb.add_option("--closures", options.closures,
                  "Frames of a URDF that coincide: closed_loop, a list of pairs; type, 6d or 3d of each; "
                  "name_mot, the "
                  "joints that are driven (YAML)")
      ->type_name("FILE");
  verb.add_option("--platform", options.platform, "The link, or a frame on it, that the robot moves")
      ->required()
      ->type_name("LINK");
  verb.add_option("--drives", options.drives,
                  "The joints that are driven [as transmissions, actuators or closures say]")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->type_name("JOINT,...");
  verb.add_option(
          "--guess", options.guess,
          "About where joints are at home, in degrees, or mm of those that slide [0]; any number of them")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->type_name("JOINT=NUMBER");
  verb.add_option("--massless", options.massless, "Links whose mass is none of the robot, such as markers")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->type_name("LINK,...");
  verb.add_option("-o,--out", options.out, "The robot file")->required()->type_name("ROBOT.yaml");
}

}  // namespace flinch
