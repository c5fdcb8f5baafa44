#include "experiments/speed_limit/speed_limit_output.h"

#include <fmt/core.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "experiments/speed_limit/speed_limit_study.h"
#include "experiments/verdict/body_regions.h"
#include "systems/foundation/json_text.h"

namespace flinch {
namespace {

using Json = nlohmann::ordered_json;
using Bound = FoundSpeed::Bound;

/// 0 where not even the slowest speed is within the limits.
double speed_of(const SpeedLimit& limit) { return limit.found->speed.value_or(0.0); }

bool is_bound_by_force(const SpeedLimit& limit) { return limit.found && limit.found->bound == Bound::force; }

/// The lowest speed of those that are asked for; null: there are none.
template <class Asked>
const SpeedLimit* slowest(const std::vector<SpeedLimit>& limits, const Asked& is_asked) {
  const SpeedLimit* lowest = nullptr;
  for (const SpeedLimit& each : limits) {
    if (is_asked(each) && (lowest == nullptr || speed_of(each) < speed_of(*lowest))) lowest = &each;
  }
  return lowest;
}

std::string place_of(const SpeedLimit& limit) {
  return fmt::format("{} at x = {:.3f} m, y = {:.3f} m, moving towards {:g} degrees", limit.cell.body,
                     limit.cell.place.x(), limit.cell.place.y(), limit.cell.direction_deg);
}

std::string forces_of(const ForceLimits& limits) {
  return fmt::format("{:g} N, or {:g} N after {:g} s ({})", limits.transient, limits.quasi_static,
                     limits.transient_duration, region_of(limits));
}

/// What is not known beside an answer of `speed` [m/s].
std::string unknown_beside(const std::vector<SpeedLimit>& limits, double speed) {
  const auto none = std::count_if(limits.begin(), limits.end(),
                                  [](const SpeedLimit& each) { return !each.found.has_value(); });
  const auto no_room = std::count_if(limits.begin(), limits.end(), [speed](const SpeedLimit& each) {
    return each.found && each.found->bound == Bound::motion && speed_of(each) < speed;
  });
  std::string text;
  if (no_room > 0) text += fmt::format("; {} cells are not tested up to that speed", no_room);
  if (none > 0) text += fmt::format("; in {} of {} cells nothing can be run into", none, limits.size());
  return text;
}

// ---------------------------------------------------------------- table

std::string cell_text(const SpeedLimit& limit) {
  if (!limit.found) return "-";
  if (!limit.found->speed) return limit.found->bound == Bound::force ? "0" : "-";
  return fmt::format("{}{:.3f}", limit.found->bound == Bound::force ? "" : ">=", *limit.found->speed);
}

/// Names in the order in which they first come.
std::vector<std::string> bodies_of(const std::vector<SpeedLimit>& limits) {
  std::vector<std::string> bodies;
  for (const SpeedLimit& limit : limits) {
    if (std::find(bodies.begin(), bodies.end(), limit.cell.body) == bodies.end())
      bodies.push_back(limit.cell.body);
  }
  return bodies;
}

std::vector<double> directions_of(const std::vector<SpeedLimit>& limits) {
  std::vector<double> directions;
  for (const SpeedLimit& limit : limits) {
    if (std::find(directions.begin(), directions.end(), limit.cell.direction_deg) == directions.end())
      directions.push_back(limit.cell.direction_deg);
  }
  return directions;
}

std::string table_of(const std::string& body, const std::vector<SpeedLimit>& limits) {
  std::string text = fmt::format("\n{:<10} {:>8} {:>8} ", body, "x m", "y m");
  for (const double direction : directions_of(limits)) text += fmt::format(" {:>7g}", direction);
  text += " deg";
  const SpeedLimit* before = nullptr;
  for (const SpeedLimit& limit : limits) {
    if (limit.cell.body != body) continue;
    if (before == nullptr || before->cell.place != limit.cell.place)
      text += fmt::format("\n{:<10} {:>8.3f} {:>8.3f} ", "", limit.cell.place.x(), limit.cell.place.y());
    text += fmt::format(" {:>7}", cell_text(limit));
    before = &limit;
  }
  return text + "\n";
}

}  // namespace

std::string speed_limit_sentence(const SpeedLimitStudy& study, const std::vector<SpeedLimit>& limits) {
  const std::string what =
      fmt::format("{:g} % of contacts exceed {}, with a confidence of {:g} % in each cell",
                  100.0 * study.share, forces_of(study.limits), 100.0 * study.confidence);
  const auto is_known = [](const SpeedLimit& each) { return each.found && each.found->speed; };
  if (const SpeedLimit* const lowest = slowest(limits, is_bound_by_force)) {
    const double speed = speed_of(*lowest);
    const std::string unknown = unknown_beside(limits, speed);
    if (speed > 0.0) {
      return fmt::format("Up to {:.3g} m/s fewer than {}; lowest is {}{}.", speed, what, place_of(*lowest),
                         unknown);
    }
    return fmt::format("Not even at {:g} m/s is it shown that fewer than {}: of {}{}.", study.search.slowest,
                       what, place_of(*lowest), unknown);
  }
  if (const SpeedLimit* const lowest = slowest(limits, is_known)) {
    return fmt::format("At all speeds that could be tried, up to {:.3g} m/s and more, fewer than {}{}.",
                       speed_of(*lowest), what, unknown_beside(limits, 0.0));
  }
  return fmt::format("Nothing is known: in none of {} cells the robot runs into the obstacle.",
                     limits.size());
}

std::string speed_limit_table(const SpeedLimitStudy& study, const std::vector<SpeedLimit>& limits) {
  std::string text = fmt::format(
      "{}: limit speeds in m/s, {} contacts of each cell\n"
      ">= no force limits it: faster it does not get there, or was not tried; 0 the slowest speed is too "
      "fast; - nothing to be run into\n",
      study.campaign.title, study.search.trials);
  for (const std::string& body : bodies_of(limits)) text += table_of(body, limits);
  return text + "\n" + speed_limit_sentence(study, limits) + "\n";
}

std::string speed_limit_json(const SpeedLimitStudy& study, const std::vector<SpeedLimit>& limits) {
  Json cells = Json::array();
  for (const SpeedLimit& limit : limits) {
    const bool has_speed = limit.found && limit.found->speed;
    const bool is_known = limit.found && (has_speed || limit.found->bound == Bound::force);
    cells.push_back({{"x_m", limit.cell.place.x()},
                     {"y_m", limit.cell.place.y()},
                     {"direction_deg", limit.cell.direction_deg},
                     {"body", limit.cell.body},
                     {"speed_m_per_s", is_known ? Json(speed_of(limit)) : Json(nullptr)},
                     {"confidence", has_speed ? Json(limit.confidence) : Json(nullptr)}});
  }
  return json_text(Json{{"cells", cells}, {"summary", speed_limit_sentence(study, limits)}});
}

}  // namespace flinch
