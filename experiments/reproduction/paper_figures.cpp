#include "experiments/reproduction/paper_figures.h"

#include <algorithm>

#include "experiments/reproduction/figure_path.h"
#include "systems/config/config_reader.h"
#include "systems/foundation/nearest_name.h"
#include "systems/foundation/setup_error.h"

namespace flinch {
namespace {

void check_path(ConfigReader& reader, const char* key, const std::string& path) {
  const std::string problem = path.empty() ? "" : problem_with_path(path);
  if (!problem.empty()) reader.problem(key, problem);
}

std::optional<FigureSource> read_source(ConfigReader& entry, const char* name) {
  if (!entry.has(name)) return std::nullopt;
  FigureSource source;
  ConfigReader reader = entry.section(name);
  const std::string_view kind = reader.one_of({"scenario", "campaign"});
  source.is_campaign = kind == "campaign";
  if (!kind.empty()) reader.required().file(kind, source.file);
  for (ConfigReader& value : reader.sections("set")) {
    std::string key, text;
    value.required().text("key", key);
    value.required().text("value", text);
    source.set.push_back(key + "=" + text);
  }
  if (source.is_campaign && reader.has("runs")) {
    int runs = 1;
    reader.integer("runs", runs, 1);
    source.runs = static_cast<std::size_t>(runs);
  }
  reader.required().text("figure", source.figure);
  reader.text("less", source.less);
  check_path(reader, "figure", source.figure);
  check_path(reader, "less", source.less);
  return source;
}

PaperFigure read_figure(ConfigReader& entry) {
  PaperFigure figure;
  entry.required().text("id", figure.id);
  entry.required().text("source", figure.source);
  entry.required().text("title", figure.title);
  entry.text("unit", figure.unit);
  entry.required().number("paper", unit::none, figure.paper);
  entry.choice("better", figure.better,
               {{"neither", PaperFigure::Better::neither},
                {"lower", PaperFigure::Better::lower},
                {"higher", PaperFigure::Better::higher}});
  entry.number("within", unit::none, figure.within, between(1.0, 1e6));
  entry.text("reason", figure.reason);
  figure.as_printed = read_source(entry, "as_printed");
  figure.ours = read_source(entry, "ours");
  if (!figure.as_printed && !figure.ours) entry.problem("", "has neither 'as_printed' nor 'ours'");
  return figure;
}

}  // namespace

std::vector<PaperFigure> read_paper_figures(const std::filesystem::path& file) {
  ConfigReader reader = ConfigReader::open(file);
  std::vector<PaperFigure> figures;
  for (ConfigReader& entry : reader.required().sections("figures")) {
    figures.push_back(read_figure(entry));
    const std::string& id = figures.back().id;
    const auto same = [&id](const PaperFigure& other) { return other.id == id; };
    if (!id.empty() && std::count_if(figures.begin(), figures.end(), same) > 1)
      entry.problem("id", "is '" + id + "', as that of another figure");
  }
  reader.finish();
  return figures;
}

std::vector<PaperFigure> figures_called(const std::vector<PaperFigure>& figures, const std::string& only) {
  std::vector<PaperFigure> called;
  std::vector<std::string> ids;
  for (const PaperFigure& figure : figures) {
    ids.push_back(figure.id);
    if (("." + figure.id + ".").find("." + only + ".") != std::string::npos) called.push_back(figure);
  }
  if (called.empty()) throw SetupError("no figure is called '" + only + "'" + did_you_mean(only, ids));
  return called;
}

}  // namespace flinch
