#include "experiments/bus/link_report.h"

#include <fmt/core.h>

#include <nlohmann/json.hpp>

#include "systems/foundation/json_text.h"
#include "systems/signals/sampling.h"

namespace flinch {
namespace {

using Json = nlohmann::ordered_json;

double microseconds(Time time) { return 1e6 * to_seconds(time); }

std::string row(const char* what, const DurationHistogram& histogram) {
  const auto summary = histogram.summary();
  if (!summary) return fmt::format("{:<22} {:>9}\n", what, "none");
  return fmt::format("{:<22} {:>9} {:>9.0f} {:>9.0f} {:>9.0f} {:>9.0f}\n", what, summary->count,
                     microseconds(summary->p50), microseconds(summary->p99), microseconds(summary->p99_9),
                     microseconds(summary->max));
}

Json json_of(const DurationHistogram& histogram) {
  const auto summary = histogram.summary();
  if (!summary) return nullptr;
  return {{"count", summary->count},
          {"p50_us", microseconds(summary->p50)},
          {"p99_us", microseconds(summary->p99)},
          {"p99_9_us", microseconds(summary->p99_9)},
          {"max_us", microseconds(summary->max)}};
}

Json json_of(const std::vector<SeenRobot>& robots) {
  Json list = Json::array();
  for (const SeenRobot& robot : robots)
    list.push_back({{"id", robot_id_text(robot.id)}, {"name", robot.name}});
  return list;
}

Json json_of(bool known, const PlatformVector& numbers) {
  if (!known) return nullptr;
  return std::vector<double>(numbers.begin(), numbers.end());
}

}  // namespace

std::vector<std::string> LinkReport::objections() const {
  std::vector<std::string> found;
  if (robots.size() > 1 && (!is_chosen || link.robot_id == 0)) {
    found.push_back(fmt::format("there are {} robots; choose one with --robot, by its name or its identity",
                                robots.size()));
    if (link.robot_id == 0) return found;
  }
  const auto round_trip = times.round_trip.summary();
  const auto age = times.age.summary();
  const Time max_age = longest_age(period);
  if (!round_trip) found.push_back("the robot has obeyed none of our commands: another program commands it");
  if (round_trip && round_trip->p99 > period) {
    found.push_back(fmt::format("one command in a hundred takes more than {:.0f} us, longer than a tick",
                                microseconds(round_trip->p99)));
  }
  if (age && age->p99_9 > max_age) {
    found.push_back(
        fmt::format("one reading in a thousand is older than {:.0f} us; above {:.0f} none is used",
                    microseconds(age->p99_9), microseconds(max_age)));
  }
  if (1000ull * link.lost > link.received) {
    found.push_back(fmt::format("{} of {} readings were lost", link.lost, link.received + link.lost));
  }
  if (1000 * loop.lost_periods > loop.ticks)
    found.push_back(fmt::format("{} ticks of this program were lost", loop.lost_periods));
  return found;
}

std::string LinkReport::table() const {
  std::string text =
      fmt::format("{:<22} {:>9} {:>9} {:>9} {:>9} {:>9}\n", "[us]", "count", "p50", "p99", "p99.9", "most");
  text += row("round trip", times.round_trip);
  text += row("age of readings", times.age);
  text += row("between two readings", times.interval);
  text += row("lateness of ticks", loop.lateness);
  text += fmt::format(
      "\nreadings  {} received, {} lost, {} refused, {} times none for 5 ms\nticks     {}: {} late starts, "
      "{} overruns, {} lost\n",
      link.received, link.lost, link.refused, link.deadlines_missed, loop.ticks, loop.late_starts,
      loop.overruns, loop.lost_periods);
  text +=
      fmt::format("robots    {}{}\n", text_of(robots),
                  link.robot_id == 0 ? "; none was measured" : "; measured: " + robot_id_text(link.robot_id));
  if (link.robot_id != 0) text += pose.text() + "\n";
  const std::vector<std::string> against = objections();
  text += fmt::format("link: {} for control at {:g} kHz\n", against.empty() ? "good" : "not good",
                      1e-3 / to_seconds(period));
  for (const std::string& objection : against) text += "  - " + objection + "\n";
  return text;
}

std::string LinkReport::json() const {
  const std::vector<std::string> against = objections();
  const Json json = {
      {"good", against.empty()},
      {"round_trip", json_of(times.round_trip)},
      {"age", json_of(times.age)},
      {"interval", json_of(times.interval)},
      {"lateness", json_of(loop.lateness)},
      {"robot", link.robot_id == 0 ? Json(nullptr) : Json(robot_id_text(link.robot_id))},
      {"robots", json_of(robots)},
      {"received", link.received},
      {"lost", link.lost},
      {"refused", link.refused},
      {"deadlines_missed", link.deadlines_missed},
      {"ticks", loop.ticks},
      {"late_starts", loop.late_starts},
      {"overruns", loop.overruns},
      {"lost_periods", loop.lost_periods},
      {"active", json_of(pose.joints.valid, pose.joints.active)},
      {"active_rad", json_of(pose.joints.valid, pose.joints.active)},  // the older name, for drives that turn
      {"passive_rad", json_of(pose.joints.passive_valid, pose.joints.passive)},
      {"platform", json_of(pose.platform.has_value(), pose.platform.value_or(Configuration()))},
      {"closure_error_m", pose.closure_error ? Json(*pose.closure_error) : Json(nullptr)},
      {"objections", against}};
  return json_text(json);
}

}  // namespace flinch
