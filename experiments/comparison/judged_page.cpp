#include "experiments/comparison/judged_page.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string_view>

#include "experiments/comparison/judged_page/judged_page_template.h"
#include "experiments/report/script_data.h"
#include "systems/foundation/json_text.h"

namespace flinch {
namespace {

using JudgedJson = nlohmann::ordered_json;

constexpr std::string_view other_wrench = "wrench_";
constexpr double band = 0.1;  // how long a marked contact is drawn [s]

/// The signal that another one is drawn like; "" where it is not drawn. Open loop, what the control asks for
/// tells nothing of the robot.
std::string drawn_like(const std::string& path) {
  if (path == "reaction" || path == "torque_command") return "";
  if (path.starts_with(other_wrench)) return "wrench";
  if (path.starts_with("detection")) return "detection";
  const auto fields = charted_fields();
  const bool is_charted = std::any_of(fields.begin(), fields.end(),
                                      [&](const ChartedField& what) { return what.signal == path; });
  return is_charted ? path : "";
}

/// States that change from sample to sample, as [sample, state] of each change.
JudgedJson changes_of(const std::vector<int>& states) {
  JudgedJson changes = JudgedJson::array();
  for (std::size_t k = 0; k < states.size(); ++k) {
    if (k == 0 || states[k] != states[k - 1]) changes.push_back({k, states[k]});
  }
  return changes;
}

JudgedJson lane(const std::string& name, const std::vector<std::string>& words,
                const std::vector<int>& states) {
  return {{"name", name}, {"states", words}, {"changes", changes_of(states)}};
}

JudgedJson detectors_json(const JudgedLog& judged, const JudgedFacts& facts) {
  JudgedJson rows = JudgedJson::array();
  for (const std::string& by : judged.by) {
    JudgedJson delays = JudgedJson::array();
    for (const std::optional<double>& delay : judged.delays.at(by))
      delays.push_back(delay ? JudgedJson(*delay) : JudgedJson(nullptr));
    const double at_most = facts.at_most.at(by);
    rows.push_back({{"by", by},
                    {"detections", judged.count_by(by)},
                    {"false_alarms", judged.false_alarms.at(by)},
                    {"at_most", std::isfinite(at_most) ? JudgedJson(at_most) : JudgedJson(nullptr)},
                    {"delays", delays}});
  }
  return rows;
}

/// When a contact ends, or until when a marked one is drawn [s].
double end_of(double begin, const LogTruth& truth) {
  for (const LogTruth::Stretch& contact : truth.measured) {
    if (contact.from == begin) return contact.to;
  }
  return begin + band;
}

JudgedJson contacts_json(const JudgedLog& judged, const LogTruth& truth) {
  std::vector<double> begins = truth.contacts;
  std::sort(begins.begin(), begins.end());
  JudgedJson contacts = JudgedJson::array();
  for (std::size_t i = 0; i < begins.size(); ++i) {
    const std::optional<double> delay = judged.delays.at(judged.by.front())[i];
    contacts.push_back({{"start", begins[i]},
                        {"removed", end_of(begins[i], truth)},
                        {"detected", delay ? JudgedJson(begins[i] + *delay) : JudgedJson(nullptr)}});
  }
  return contacts;
}

}  // namespace

JudgedPage::JudgedPage(double first, double last, double period) : axis_(chart_axis(first, last, period)) {}

bool JudgedPage::shows(const std::string& path) { return !drawn_like(path).empty(); }

void JudgedPage::see(const Recording& latest) {
  for (const Signal& signal : latest.signals) {
    const std::string like = drawn_like(signal.path);
    if (like.empty()) continue;
    drawings_.try_emplace(signal.path, signal.path, axis_, 0.0, like).first->second.see(latest);
  }
}

/// Wrenches of other estimators beside that which is followed.
JudgedJson JudgedPage::charts(const std::vector<std::string>& sources) const {
  std::map<std::string, std::vector<DrawnSignal>> drawn;
  for (const auto& [path, drawing] : drawings_) {
    const std::string source = path == "wrench"                 ? sources[1]
                               : path.starts_with(other_wrench) ? path.substr(other_wrench.size())
                                                                : sources[0];
    const auto run = std::find(sources.begin(), sources.end(), source) - sources.begin();
    drawn[drawn_like(path)].push_back({static_cast<std::size_t>(run), drawing.components()});
  }
  drawn.erase("detection");  // lanes show it
  JudgedJson charts = JudgedJson::array();
  for (const ChartedField& what : charted_fields()) add_charts(what, drawn[what.signal], charts);
  return charts;
}

JudgedJson JudgedPage::lanes(const JudgedLog& judged, const LogTruth& truth) const {
  JudgedJson lanes = JudgedJson::array();
  std::vector<int> marked(axis_.count, 0);
  for (std::size_t k = 0; k < axis_.count; ++k) {
    const double now = axis_.start + static_cast<double>(k) * axis_.period;
    for (const LogTruth::Stretch& stretch : truth.free) {
      if (stretch.contains(now)) marked[k] = 1;
    }
    for (const double contact : truth.contacts) {
      if (contact <= now && now < end_of(contact, truth)) marked[k] = 2;
    }
  }
  const bool has_ends = !truth.measured.empty();
  lanes.push_back(
      lane(truth.source, {"not judged", "free", has_ends ? "contact" : "contact begins"}, marked));
  for (std::size_t i = 0; i < judged.by.size(); ++i) {
    const auto drawing = drawings_.find(judged.signals[i]);
    if (drawing == drawings_.end()) continue;
    std::vector<int> states(axis_.count, -1);
    for (const DrawnComponent& level : drawing->second.components()) {
      if (level.field != "present_level") continue;
      for (std::size_t k = 0; k < states.size(); ++k) {
        if (!std::isnan(level.values[k])) states[k] = std::max(states[k], level.values[k] > 0.0 ? 1 : 0);
      }
    }
    lanes.push_back(lane(judged.by[i], {"nothing", "contact"}, states));
  }
  return lanes;
}

std::string JudgedPage::html(const JudgedLog& judged, const LogTruth& truth, const JudgedFacts& facts) const {
  std::vector<std::string> sources = {"log", facts.estimator};
  for (const auto& [path, drawing] : drawings_) {
    if (path.starts_with(other_wrench)) sources.push_back(path.substr(other_wrench.size()));
  }
  JudgedJson runs = JudgedJson::array();
  for (const std::string& source : sources) runs.push_back({{"name", source}});
  const JudgedJson data = {{"name", facts.name},
                           {"told", facts.told},
                           {"detectors", detectors_json(judged, facts)},
                           {"events", facts.events},
                           {"free_seconds", judged.free_seconds},
                           {"truth", truth.source},
                           {"runs", runs},
                           {"start", axis_.start},
                           {"period", axis_.period},
                           {"count", axis_.count},
                           {"charts", charts(sources)},
                           {"contacts", contacts_json(judged, truth)},
                           {"lanes", lanes(judged, truth)},
                           {"call", facts.call},
                           {"version", "flinch " FLINCH_VERSION}};
  return std::string(judged_page_template_before_data) + inside_script(json_text(data)) +
         std::string(judged_page_template_after_data);
}

}  // namespace flinch
