#include "experiments/speed_limit/speed_limit_page.h"

#include <array>
#include <nlohmann/json.hpp>
#include <optional>

#include "experiments/report/drawn_robot.h"
#include "experiments/report/script_data.h"
#include "experiments/speed_limit/page/speed_limit_page_template.h"
#include "experiments/speed_limit/speed_limit_output.h"
#include "experiments/speed_limit/speed_limit_study.h"
#include "experiments/verdict/body_regions.h"
#include "systems/foundation/json_text.h"
#include "systems/robot/parallel_robot.h"

namespace flinch {
namespace {

using Json = nlohmann::ordered_json;

Json from_above(const CartesianVector& point) { return Json::array({point[0], point[1]}); }

Json known(const std::optional<double>& value) { return value ? Json(*value) : Json(nullptr); }

/// The robot at the pose of the scenario, from above, in the base frame.
Json robot_json(const ParallelRobot& robot, const Configuration& pose) {
  Kinematics there;
  robot.kinematics(pose, PlatformVector::Zero(robot.dof()), there);
  Json legs = Json::array(), platform = Json::array();
  for (int i = 0; i < robot.legs(); ++i) {
    const LegPoints& leg = there.legs[static_cast<std::size_t>(i)];
    legs.push_back(
        {from_above(leg.base_joint), from_above(leg.passive_joint), from_above(leg.coupling_joint)});
  }
  const ReportRobot drawn = drawn_robot(robot);
  for (const ReportPoint& corner : drawn.platform) {
    CartesianVector in_platform(robot.space_dimension());
    for (int i = 0; i < in_platform.size(); ++i) in_platform[i] = corner[static_cast<std::size_t>(i)];
    platform.push_back(from_above(robot.point_on_body(there, BodyId::platform(), in_platform)));
  }
  return {{"legs", legs},
          {"link_radius", drawn.link_radius},
          {"platform", platform},
          {"platform_radius", drawn.platform_radius}};
}

Json cell_json(const SpeedLimit& limit, const LimitCall& call_of) {
  constexpr std::array bounds = {"force", "motion", "fastest"};  // as FoundSpeed::Bound
  const bool has_speed = limit.found && limit.found->speed;
  Json cell = {
      {"x", limit.cell.place.x()},
      {"y", limit.cell.place.y()},
      {"direction", limit.cell.direction_deg},
      {"body", limit.cell.body},
      {"speed", has_speed ? Json(*limit.found->speed) : Json(nullptr)},
      {"bound", limit.found ? Json(bounds[static_cast<std::size_t>(limit.found->bound)]) : Json(nullptr)},
      {"reason", limit.reason},
      {"exceeded", limit.found ? Json(limit.found->exceeded) : Json(nullptr)},
      {"untested", limit.found ? Json(limit.found->untested) : Json(nullptr)},
      {"confidence", has_speed ? Json(limit.confidence) : Json(nullptr)},
      {"peak", known(limit.nearest.peak_force)},
      {"lasting", known(limit.nearest.lasting_force)},
      {"removed", known(limit.nearest.removal_time)}};
  cell["call"] = has_speed ? call_of(limit) : "";
  return cell;
}

Json limits_json(const ForceLimits& limits) {
  return {{"region", region_of(limits)},
          {"transient", limits.transient},
          {"transient_source", limits.transient_source},
          {"transient_duration", limits.transient_duration},
          {"quasi_static", limits.quasi_static},
          {"quasi_static_source", limits.quasi_static_source}};
}

}  // namespace

std::string speed_limit_page(const SpeedLimitStudy& study, const std::vector<SpeedLimit>& limits,
                             const LimitCall& call_of, const std::string& call) {
  Json cells = Json::array();
  for (const SpeedLimit& limit : limits) cells.push_back(cell_json(limit, call_of));
  const Campaign& campaign = study.campaign;
  const Json data = {{"title", campaign.title},
                     {"description", campaign.description},
                     {"sentence", speed_limit_sentence(study, limits)},
                     {"share", study.share},
                     {"confidence", study.confidence},
                     {"trials", study.search.trials},
                     {"tolerated", study.search.tolerated},
                     {"spares", study.search.spares},
                     {"slowest", study.search.slowest},
                     {"fastest", study.search.fastest},
                     {"limits", limits_json(study.limits)},
                     {"robot", robot_json(*study.robot, study.pose)},
                     {"cells", cells},
                     {"provenance",
                      {{"Version", "flinch " FLINCH_VERSION},
                       {"File", campaign.file.filename().string()},
                       {"Seed", std::to_string(campaign.seed)},
                       {"Call", call}}},
                     {"text", campaign.scenario_texts.front()}};
  return std::string(speed_limit_page_template_before_data) + inside_script(json_text(data)) +
         std::string(speed_limit_page_template_after_data);
}

}  // namespace flinch
