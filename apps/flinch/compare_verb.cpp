// flinch compare: two recordings or more, side by side.
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <thread>

#include "apps/flinch/command_line.h"
#include "apps/flinch/conclusion.h"
#include "apps/flinch/output_place.h"
#include "apps/flinch/printing.h"
#include "apps/flinch/simulated/simulated_parts.h"
#include "experiments/comparison/comparison.h"
#include "experiments/comparison/comparison_page.h"
#include "experiments/recorded/judged_log.h"
#include "experiments/report/scenario_verdict.h"
#include "experiments/scenario/scenario.h"
#include "experiments/verdict/verdict.h"
#include "systems/config/file_kind.h"
#include "systems/foundation/json_text.h"
#include "systems/foundation/problems_of_place.h"
#include "systems/foundation/result_file.h"
#include "systems/foundation/setup_error.h"
#include "systems/framework/recording.h"

namespace flinch {
namespace {

using Json = nlohmann::ordered_json;
using Align = CompareOptions::Align;

/// A recording, and what its scenario and its verdict say, as far as it has them.
struct Compared {
  std::filesystem::path file;
  Recording recording;
  std::vector<ReadValue> settings;
  std::optional<Verdict> verdict;
};

std::vector<ReadValue> settings_of(const Recording& recording, const Scenario& scenario) {
  std::vector<ReadValue> settings = scenario.values;
  std::erase_if(settings, [](const ReadValue& value) { return value.key == "seed"; });  // of the file
  settings.push_back({"seed", std::to_string(scenario.seed), "", true});
  const auto version = recording.attributes.find("flinch.version");
  if (version != recording.attributes.end())
    settings.push_back({"flinch.version", version->second, "", true});
  for (ReadValue value : scenario.robot.values) {
    value.key = "robot: " + value.key;
    settings.push_back(std::move(value));
  }
  return settings;
}

Compared opened(const std::filesystem::path& file) {
  require_no_kind(file, "a recording");
  Compared one{file, open_recording(file), {}, std::nullopt};
  const bool keeps_scenario = one.recording.attributes.contains("scenario.text");
  if (!keeps_scenario) return one;
  const Scenario scenario = scenario_of(one.recording, file);
  one.settings = settings_of(one.recording, scenario);
  if (!holds_readings_alone(one.recording))
    one.verdict = out_of(file, [&] { return verdict_of(scenario, one.recording); });
  return one;
}

/// All of them, opened and judged at once.
std::vector<Compared> opened(const std::vector<std::filesystem::path>& files) {
  std::vector<std::optional<Compared>> compared(files.size());
  std::vector<std::vector<std::string>> problems(files.size());
  {
    std::vector<std::jthread> workers;
    for (std::size_t i = 0; i < files.size(); ++i) {
      workers.emplace_back([&, i] {
        try {
          compared[i] = opened(files[i]);
        } catch (const SetupError& error) {
          problems[i] = error.problems();
        } catch (const std::exception& error) {
          problems[i] = {files[i].string() + ": " + error.what()};
        }
      });
    }
  }
  std::vector<std::string> all;
  for (const auto& some : problems) all.insert(all.end(), some.begin(), some.end());
  throw_if_any(std::move(all));
  std::vector<Compared> result;
  for (auto& one : compared) result.push_back(std::move(*one));
  return result;
}

// ---------------------------------------------------------------- what is told

/// When the first contact begins, or was first detected where nobody else saw it.
double contact_in(const Compared& one) {
  if (one.verdict && !one.verdict->contacts.empty()) return one.verdict->contacts.front().onset;
  if (one.verdict && !one.verdict->detections.empty()) return one.verdict->detections.front();
  throw SetupError(one.file.string() +
                   ": has no contact, so it cannot be aligned by one; --align time or correlation");
}

double delay_of(const Compared& one, const Compared& first, Align align) {
  if (align == Align::time || &one == &first) return 0.0;
  if (align == Align::contact) return contact_in(one) - contact_in(first);
  return out_of(first.file.string() + " and " + one.file.string(),
                [&] { return delay_by_correlation(first.recording, one.recording); });
}

std::string told(const std::optional<double>& seconds) {
  return seconds ? fmt::format("{:.1f} ms", 1e3 * *seconds) : "never";
}

std::vector<std::pair<std::string, std::string>> told_verdict(const std::optional<Verdict>& verdict) {
  if (!verdict) return {};
  std::vector<std::pair<std::string, std::string>> rows = {
      {"verdict", verdict->good() ? "good" : "bad"},
      {"fault", verdict->fault.empty() ? "none" : verdict->fault},
      {"contacts", std::to_string(verdict->contacts.size())}};
  if (!verdict->contacts.empty()) {
    const ContactVerdict& first = verdict->contacts.front();
    const auto since = [&](const std::optional<double>& time) {
      return told(time ? std::optional(*time - first.onset) : std::nullopt);
    };
    rows.emplace_back("first contact with", first.body.empty() ? "not measured" : first.body);
    rows.emplace_back("at", fmt::format("{:.3f} s", first.onset));
    rows.emplace_back("detected after", since(first.detected));
    rows.emplace_back("removed after", since(first.removed));
    rows.emplace_back("largest force", fmt::format("{:.1f} N", first.peak_force));
    rows.emplace_back("within its limit", first.within_limit ? "yes" : "no");
  }
  rows.emplace_back("detections", std::to_string(verdict->detections.size()));
  rows.emplace_back("false detections", std::to_string(verdict->false_detections));
  rows.emplace_back("observer error", fmt::format("{:.2f} N, {:.3f} Nm", verdict->max_observer_error_force,
                                                  verdict->max_observer_error_moment));
  rows.emplace_back("tracking error", fmt::format("{:.2f} mm", 1e3 * verdict->max_tracking_error));
  for (const std::string& failure : verdict->failures) rows.emplace_back("failure", failure);
  return rows;
}

/// The first difference of all from the first one.
struct Parting {
  FirstDifference difference;
  std::size_t with = 0;  ///< number of the recording
};

std::optional<Parting> parting_of(const std::vector<Compared>& compared) {
  std::optional<Parting> first;
  for (std::size_t i = 1; i < compared.size(); ++i) {
    auto found = first_difference(compared.front().recording, compared[i].recording);
    if (found && (!first || found->tick < first->difference.tick)) first = Parting{std::move(*found), i};
  }
  return first;
}

std::string sentence(const std::optional<Parting>& parting, const std::vector<Compared>& compared) {
  if (!parting) return "All signals that they share are the same, bit for bit.";
  const FirstDifference& first = parting->difference;
  std::string text =
      fmt::format("They part at tick {} ({:.3f} s) in '{}'", first.tick, first.time, first.signal);
  if (!first.others.empty()) text += fmt::format(" and {} more signals", first.others.size());
  if (compared.size() > 2) text += ", " + compared[parting->with].file.string() + " from the first";
  return text + ".";
}

Json parting_json(const std::optional<Parting>& parting) {
  if (!parting) return nullptr;
  const FirstDifference& first = parting->difference;
  return {{"tick", first.tick},
          {"signal", first.signal},
          {"time_s", first.time},
          {"other_signals", first.others},
          {"recording", parting->with}};
}

Json settings_json(const std::vector<SettingDifference>& settings) {
  Json list = Json::array();
  for (const SettingDifference& setting : settings) {
    Json values = Json::array();
    for (const auto& value : setting.values) values.push_back(value ? Json(*value) : Json(nullptr));
    list.push_back({{"key", setting.key}, {"unit", setting.unit}, {"values", values}});
  }
  return list;
}

Json compared_json(const std::vector<Compared>& compared, const std::vector<double>& delays) {
  Json list = Json::array();
  for (std::size_t i = 0; i < compared.size(); ++i) {
    const Compared& one = compared[i];
    Json verdict = Json::object();
    for (const auto& [name, value] : told_verdict(one.verdict)) {
      if (name != "failure") verdict[name] = value;
    }
    list.push_back({{"file", one.file.string()},
                    {"samples", one.recording.samples()},
                    {"delay_s", delays[i]},
                    {"verdict", one.verdict ? verdict : Json(nullptr)}});
  }
  return list;
}

void print_side_by_side(const std::string& name, const std::vector<std::optional<std::string>>& values) {
  std::string line = fmt::format("{:<40}", name);
  for (const auto& value : values) line += fmt::format(" {:>20}", value.value_or("-"));
  print_result("{}\n", line);
}

void print_compared(const std::vector<Compared>& compared, const std::vector<SettingDifference>& settings) {
  std::vector<std::optional<std::string>> names;
  for (std::size_t i = 0; i < compared.size(); ++i) {
    print_result("{}: {}\n", static_cast<char>('A' + static_cast<int>(i % 26)), compared[i].file.string());
    names.emplace_back(std::string(1, static_cast<char>('A' + static_cast<int>(i % 26))));
  }
  print_result("\n");
  print_side_by_side("", names);
  std::vector<std::vector<std::pair<std::string, std::string>>> rows;
  std::vector<std::string> order;
  for (const Compared& one : compared) {
    rows.push_back(told_verdict(one.verdict));
    for (const auto& [name, value] : rows.back())
      if (name != "failure" && std::find(order.begin(), order.end(), name) == order.end())
        order.push_back(name);
  }
  for (const std::string& name : order) {
    std::vector<std::optional<std::string>> values;
    for (const auto& of_one : rows) {
      const auto row =
          std::find_if(of_one.begin(), of_one.end(), [&](const auto& each) { return each.first == name; });
      values.push_back(row == of_one.end() ? std::nullopt : std::optional(row->second));
    }
    print_side_by_side(name, values);
  }
  print_result("\n{} {}\n", settings.size(), settings.size() == 1 ? "setting differs" : "settings differ");
  for (const SettingDifference& setting : settings)
    print_side_by_side(setting.unit.empty() ? setting.key : setting.key + " [" + setting.unit + "]",
                       setting.values);
}

/// Names for a page: the files, as short as they differ.
std::vector<std::string> short_names(const std::vector<Compared>& compared) {
  std::vector<std::string> names;
  for (const Compared& one : compared) {
    std::string name = one.file.filename().string();
    const bool is_shared = std::count_if(compared.begin(), compared.end(), [&](const Compared& other) {
                             return other.file.filename() == one.file.filename();
                           }) > 1;
    if (is_shared) name = one.file.string();
    while (std::find(names.begin(), names.end(), name) != names.end()) name += " again";
    names.push_back(name);
  }
  return names;
}

}  // namespace

ExitStatus compare(const CompareOptions& options) {
  if (options.recordings.size() < 2) throw SetupError("compare: needs two recordings or more");
  require_output(options.out, options.recordings, OutputKind::page);
  const std::vector<Compared> compared = opened(options.recordings);
  for (const Compared& one : compared) tell_if_partial(one.recording, options.common);
  std::vector<double> delays;
  for (const Compared& one : compared) delays.push_back(delay_of(one, compared.front(), options.align));
  std::vector<std::vector<ReadValue>> lists;
  for (const Compared& one : compared) lists.push_back(one.settings);
  const std::vector<SettingDifference> settings = differing_settings(lists);
  const std::optional<Parting> parting = parting_of(compared);

  const std::vector<std::string> names = short_names(compared);
  std::vector<ComparedRecording> drawn;
  for (std::size_t i = 0; i < compared.size(); ++i)
    drawn.push_back({names[i], &compared[i].recording, delays[i], told_verdict(compared[i].verdict),
                     compared[i].verdict && compared[i].verdict->good()});
  static constexpr std::array aligned_by = {"time", "contact", "correlation"};
  write_result(options.out,
               comparison_page(drawn, {aligned_by[static_cast<std::size_t>(options.align)],
                                       sentence(parting, compared), settings, options.common.command_line}));
  if (options.common.json) {
    print_result("{}\n", json_text(Json{
                             {"first_difference", parting_json(parting)},
                             {"settings", settings_json(settings)},
                             {"recordings", compared_json(compared, delays)},
                             {"signals_of_one", signals_of_one(compared[0].recording, compared[1].recording)},
                             {"page", options.out.string()}}));
    return ExitStatus::done;
  }
  print_compared(compared, settings);
  print_result("\n{}\n", sentence(parting, compared));
  for (std::size_t i = 1; i < compared.size(); ++i)
    if (delays[i] != 0.0) print_result("{} is {:.4f} s later\n", names[i], delays[i]);
  flush_results();
  if (!options.common.quiet) print_message("page:      {}\n", options.out.string());
  return ExitStatus::done;
}

}  // namespace flinch
