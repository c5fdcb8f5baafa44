#include "experiments/comparison/comparison_page.h"

#include <algorithm>
#include <future>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>

#include "experiments/comparison/page/comparison_page_template.h"
#include "experiments/comparison/signal_drawing.h"
#include "experiments/report/script_data.h"
#include "systems/foundation/json_text.h"

namespace flinch {
namespace {

using ComparedJson = nlohmann::ordered_json;

ChartAxis axis_of(const std::vector<ComparedRecording>& compared) {
  double first = std::numeric_limits<double>::infinity(), last = -first, period = first;
  for (const ComparedRecording& each : compared) {
    const Recording& recording = *each.recording;
    if (recording.samples() == 0) continue;
    first = std::min(first, 1e-9 * static_cast<double>(recording.time_ns.front()) - each.delay);
    last = std::max(last, 1e-9 * static_cast<double>(recording.time_ns.back()) - each.delay);
    period = std::min(period, 1e-9 * static_cast<double>(recording.period.count()));
  }
  return chart_axis(first, last, period);
}

/// The charted signals of one recording, by name.
using DrawnSignals = std::map<std::string, std::vector<DrawnComponent>>;

DrawnSignals drawn_signals(const ComparedRecording& of, const ChartAxis& axis) {
  DrawnSignals drawn;
  for (const ChartedField& what : charted_fields()) {
    if (of.recording->find(what.signal) == nullptr || drawn.contains(what.signal)) continue;
    SignalDrawing drawing(what.signal, axis, of.delay);
    drawing.see(*of.recording);
    drawn[what.signal] = drawing.components();
  }
  return drawn;
}

/// The same of all recordings, each by a thread of its own.
std::vector<DrawnSignals> drawn_signals(const std::vector<ComparedRecording>& compared,
                                        const ChartAxis& axis) {
  std::vector<std::future<DrawnSignals>> work;
  for (const ComparedRecording& each : compared)
    work.push_back(std::async(std::launch::async, [&each, &axis] { return drawn_signals(each, axis); }));
  std::vector<DrawnSignals> drawn;
  for (auto& each : work) drawn.push_back(each.get());
  return drawn;
}

/// What each recording has of a signal.
std::vector<DrawnSignal> drawn_of(const std::vector<DrawnSignals>& drawn, const char* signal) {
  std::vector<DrawnSignal> found;
  for (std::size_t run = 0; run < drawn.size(); ++run) {
    const auto there = drawn[run].find(signal);
    if (there != drawn[run].end()) found.push_back({run, there->second});
  }
  return found;
}

ComparedJson runs_json(const std::vector<ComparedRecording>& compared) {
  ComparedJson runs = ComparedJson::array();
  for (const ComparedRecording& each : compared) {
    ComparedJson verdict = ComparedJson::array();
    for (const auto& [name, value] : each.verdict) verdict.push_back({name, value});
    runs.push_back({{"name", each.name}, {"delay", each.delay}, {"good", each.good}, {"verdict", verdict}});
  }
  return runs;
}

}  // namespace

std::string comparison_page(const std::vector<ComparedRecording>& compared, const ComparisonFacts& facts) {
  const ChartAxis axis = axis_of(compared);
  ComparedJson charts = ComparedJson::array(), settings = ComparedJson::array();
  const std::vector<DrawnSignals> drawn = drawn_signals(compared, axis);
  for (const ChartedField& what : charted_fields()) add_charts(what, drawn_of(drawn, what.signal), charts);
  for (const SettingDifference& setting : facts.settings) {
    ComparedJson values = ComparedJson::array();
    for (const auto& value : setting.values)
      values.push_back(value ? ComparedJson(*value) : ComparedJson(nullptr));
    settings.push_back({{"key", setting.key}, {"unit", setting.unit}, {"values", values}});
  }
  const ComparedJson data = {{"runs", runs_json(compared)},
                             {"aligned_by", facts.aligned_by},
                             {"first_difference", facts.first_difference},
                             {"settings", settings},
                             {"start", axis.start},
                             {"period", axis.period},
                             {"count", axis.count},
                             {"charts", charts},
                             {"contacts", ComparedJson::array()},
                             {"lanes", ComparedJson::array()},
                             {"call", facts.call},
                             {"notes", facts.notes},
                             {"version", "flinch " FLINCH_VERSION}};
  return std::string(comparison_page_template_before_data) + inside_script(json_text(data)) +
         std::string(comparison_page_template_after_data);
}

}  // namespace flinch
