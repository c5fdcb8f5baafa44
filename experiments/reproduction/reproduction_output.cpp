#include <fmt/core.h>

#include <map>
#include <nlohmann/json.hpp>

#include "experiments/report/script_data.h"
#include "experiments/reproduction/page/reproduction_page_template.h"
#include "experiments/reproduction/reproduction.h"
#include "systems/foundation/json_text.h"

namespace flinch {
namespace {

using FiguresJson = nlohmann::ordered_json;
using Outcome = ReproducedFigure::Outcome;

std::string written(std::optional<double> value) { return value ? fmt::format("{:.4g}", *value) : "-"; }

FiguresJson number_json(std::optional<double> value) {
  return value ? FiguresJson(*value) : FiguresJson(nullptr);
}

FiguresJson entry_json(const ReproducedFigure& each) {
  return {{"id", each.figure.id},
          {"source", each.figure.source},
          {"title", each.figure.title},
          {"paper", each.figure.paper},
          {"as_printed", number_json(each.as_printed)},
          {"ours", number_json(each.ours)},
          {"unit", each.figure.unit},
          {"verdict", word(each.outcome)},
          {"wall_s", each.wall},
          {"reason", each.figure.reason}};
}

/// How it was set up, in words.
std::string set_up(const std::optional<FigureSource>& source) {
  if (!source) return "";
  std::string text = source->file.filename().string();
  for (const std::string& value : source->set) text += " --set " + value;
  if (source->runs) text += fmt::format(" --runs {}", *source->runs);
  return text + ": " + source->figure + (source->less.empty() ? "" : " - " + source->less);
}

FiguresJson page_entry_json(const ReproducedFigure& each) {
  FiguresJson entry = entry_json(each);
  entry["within"] = each.figure.within;
  entry["set_up"] = set_up(each.figure.as_printed);
  entry["set_up_ours"] = set_up(each.figure.ours);
  return entry;
}

std::string counts(const std::vector<ReproducedFigure>& figures) {
  std::map<Outcome, int> count;
  for (const ReproducedFigure& each : figures) ++count[each.outcome];
  return fmt::format("{} figures: {} reproduced, {} better, {} not reached", figures.size(),
                     count[Outcome::reproduced], count[Outcome::better], count[Outcome::not_reached]);
}

}  // namespace

std::string reproduction_table(const std::vector<ReproducedFigure>& figures) {
  std::string text, source;
  for (const ReproducedFigure& each : figures) {
    const PaperFigure& figure = each.figure;
    if (figure.source != source) {
      source = figure.source;
      text += fmt::format("{}{:<62} {:>9} {:>11} {:>9}  {:<6} {}\n", text.empty() ? "" : "\n", source,
                          "paper", "as printed", "ours", "unit", "verdict");
    }
    text += fmt::format("  {:<60} {:>9} {:>11} {:>9}  {:<6} {}\n", figure.title, written(figure.paper),
                        written(each.as_printed), written(each.ours), figure.unit, word(each.outcome));
    if (each.outcome == Outcome::not_reached && !figure.reason.empty())
      text += fmt::format("    {}\n", figure.reason);
  }
  return text + "\n" + counts(figures) + "\n";
}

std::string reproduction_json(const std::vector<ReproducedFigure>& figures) {
  FiguresJson entries = FiguresJson::array();
  for (const ReproducedFigure& each : figures) entries.push_back(entry_json(each));
  return json_text(FiguresJson{{"entries", entries}});
}

std::string reproduction_page(const std::vector<ReproducedFigure>& figures, const std::string& call) {
  FiguresJson entries = FiguresJson::array();
  for (const ReproducedFigure& each : figures) entries.push_back(page_entry_json(each));
  const FiguresJson data = {{"summary", counts(figures)},
                            {"entries", entries},
                            {"call", call},
                            {"version", "flinch " FLINCH_VERSION}};
  return std::string(reproduction_page_template_before_data) + inside_script(json_text(data)) +
         std::string(reproduction_page_template_after_data);
}

}  // namespace flinch
