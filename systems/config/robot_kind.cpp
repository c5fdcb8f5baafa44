#include "systems/config/robot_kind.h"

#include <algorithm>
#include <utility>

#include "systems/config/five_bar_file.h"
#include "systems/config/hexapod_file.h"
#include "systems/config/legs_file.h"
#include "systems/config/planar_rrr_file.h"
#include "systems/foundation/setup_error.h"
#include "systems/robot/five_bar.h"
#include "systems/robot/five_bar_presets.h"
#include "systems/robot/hexapod.h"
#include "systems/robot/hexapod_presets.h"
#include "systems/robot/planar_rrr.h"
#include "systems/robot/planar_rrr_presets.h"

namespace flinch {
namespace {

std::vector<RobotKind>& kinds() {
  static std::vector<RobotKind> all = {
      {"planar_3rrr", read_planar_rrr,
       std::make_shared<const PlanarRrr>(rig_robot(RigGeometry::individual, RigFriction::none))},
      {"five_bar", read_five_bar, std::make_shared<const FiveBar>(five_bar_robot())},
      {"hexapod_6ups", read_hexapod, std::make_shared<const Hexapod>(hexapod_robot())},
      {"legs", read_legs, nullptr, begin_limits_of_legs}};
  return all;
}

bool moves_alike(const ParallelRobot& robot) {
  const auto& drives = robot.description().drives;
  return !drives.empty() &&
         std::all_of(drives.begin(), drives.end(), [&](DriveKind kind) { return kind == drives.front(); });
}

}  // namespace

void add_robot_kind(RobotKind kind) {
  std::vector<std::string> problems;
  const std::string of = "robot kind '" + kind.name + "': ";
  const auto has_its_name = [&](const RobotKind& other) { return other.name == kind.name; };
  if (kind.name.empty()) problems.push_back(of + "it needs a name, which files give at 'kind'");
  if (std::any_of(kinds().begin(), kinds().end(), has_its_name))
    problems.push_back(of + "there is one already");
  if (!kind.read) problems.push_back(of + "it needs a function that reads its keys");
  if (!kind.preset) problems.push_back(of + "it needs a preset");
  if (kind.preset && !moves_alike(*kind.preset))
    problems.push_back(of + "its preset must have drives that all turn, or all slide");
  throw_if_any(std::move(problems));
  kinds().push_back(std::move(kind));
}

const std::vector<RobotKind>& robot_kinds() { return kinds(); }

}  // namespace flinch
