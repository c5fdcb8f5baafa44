#include <fmt/core.h>

#include <algorithm>
#include <cstdlib>
#include <map>
#include <nlohmann/json.hpp>
#include <utility>

#include "experiments/campaign/reaction_summary.h"
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

/// The words of a command, files by their names only.
std::string written_command(const std::vector<std::string>& words) {
  std::string text = "flinch";
  for (const std::string& word : words)
    text += " " + (word.starts_with('/') ? std::filesystem::path(word).filename().string() : word);
  return text;
}

/// What is run, in words.
std::string written_run(const RunSource& run) {
  std::string text = run.file.filename().string();
  for (const std::string& value : run.set) text += " --set " + value;
  if (run.runs) text += fmt::format(" --runs {}", *run.runs);
  for (const std::vector<std::string>& words : run.commands)
    text += (text.empty() ? "" : " && ") + written_command(words);
  return text;
}

std::string written_number(const SignalNumber& number) {
  return fmt::format("{}.{}[{}]", number.signal, number.field, number.element);
}

std::string written_curve(const SignalCurve& curve) {
  std::string text;
  for (const SignalCurve::Term& term : curve.terms) {
    text += (text.empty() ? "" : ", ") + written_number(term.of);
    if (term.less) text += " - " + written_number(*term.less);
  }
  return curve.is_length ? "|" + text + "|" : text;
}

/// How it was set up, in words.
std::string set_up(const std::optional<FigureSource>& source) {
  if (!source) return "";
  const std::string run = written_run(source->run) + ": ";
  if (source->curve)
    return run + fmt::format("{} of {}", word(source->statistic.kind), written_curve(*source->curve));
  return run + source->figure + (source->less.empty() ? "" : " - " + source->less) +
         (source->per.empty() ? "" : " / " + source->per);
}

FiguresJson page_entry_json(const ReproducedFigure& each) {
  FiguresJson entry = entry_json(each);
  entry["within"] = each.figure.within;
  entry["set_up"] = set_up(each.figure.as_printed);
  entry["set_up_ours"] = set_up(each.figure.ours);
  return entry;
}

/// Six digits, as a picture needs.
FiguresJson short_list(const std::vector<double>& values) {
  FiguresJson list = FiguresJson::array();
  for (const double value : values)
    list.push_back(std::strtod(fmt::format("{:.6g}", value).c_str(), nullptr));
  return list;
}

/// Of more points than a picture has room for, the lowest and the highest of each stretch.
PicturePoints thinned(const PicturePoints& points) {
  constexpr std::size_t most = 800;
  if (points.x.size() <= most) return points;
  const std::size_t stretch = (2 * points.x.size() + most - 1) / most;
  PicturePoints few;
  for (std::size_t first = 0; first < points.x.size(); first += stretch) {
    const auto begin = points.y.begin() + static_cast<std::ptrdiff_t>(first);
    const auto end =
        points.y.begin() + static_cast<std::ptrdiff_t>(std::min(first + stretch, points.y.size()));
    auto [low, high] = std::minmax_element(begin, end);
    if (low > high) std::swap(low, high);
    for (const auto each : {low, high}) {
      few.x.push_back(points.x[static_cast<std::size_t>(each - points.y.begin())]);
      few.y.push_back(*each);
    }
  }
  return few;
}

FiguresJson line_json(const PictureLine& line, const PicturePoints& all) {
  PicturePoints points = thinned(all);
  if (!line.over)
    for (double& time : points.x) time *= 1e3;  // ms
  return {{"name", line.name},
          {"set_up", written_run(line.run) + ": " + written_curve(line.curve)},
          {"x", short_list(points.x)},
          {"y", short_list(points.y)}};
}

FiguresJson dots_json(const PictureDots& dots, const PicturePoints& points) {
  FiguresJson json = {{"name", dots.name},
                      {"set_up", written_run(dots.run)},
                      {"x", short_list(points.x)},
                      {"y", short_list(points.y)},
                      {"line", nullptr}};
  const std::optional<ForceFit> fit = dots.with_line ? fit_line(points.x, points.y) : std::nullopt;
  if (fit) json["line"] = {{"slope", fit->slope}, {"intercept", fit->intercept}};
  return json;
}

FiguresJson picture_json(const DrawnPicture& drawn) {
  const PaperPicture& picture = drawn.picture;
  FiguresJson json = {{"id", picture.id},
                      {"source", picture.source},
                      {"title", picture.title},
                      {"note", picture.note},
                      {"x_title", picture.x_title},
                      {"y_title", picture.y_title},
                      {"lines", FiguresJson::array()},
                      {"dots", FiguresJson::array()},
                      {"marks", FiguresJson::array()}};
  for (std::size_t i = 0; i < drawn.lines.size(); ++i)
    json["lines"].push_back(line_json(picture.lines[i], drawn.lines[i]));
  for (std::size_t i = 0; i < drawn.dots.size(); ++i)
    json["dots"].push_back(dots_json(picture.dots[i], drawn.dots[i]));
  if (picture.matrix)
    json["matrix"] = {{"classes", drawn.matrix.classes},
                      {"rows", drawn.matrix.rows},
                      {"set_up", written_run(picture.matrix->run)}};
  for (const PictureMark& mark : picture.marks)
    json["marks"].push_back({{"name", mark.name}, {"at", mark.at}, {"upright", mark.upright}});
  return json;
}

std::string counts(const std::vector<ReproducedFigure>& figures) {
  std::map<Outcome, int> count;
  for (const ReproducedFigure& each : figures) ++count[each.outcome];
  return fmt::format("{} figures: {} reproduced, {} better, {} not reached", figures.size(),
                     count[Outcome::reproduced], count[Outcome::better], count[Outcome::not_reached]);
}

}  // namespace

std::string reproduction_table(const Reproduction& reproduction) {
  const std::vector<ReproducedFigure>& figures = reproduction.figures;
  std::string text, source;
  std::size_t wide = 0;
  for (const ReproducedFigure& each : figures) wide = std::max(wide, each.figure.title.size());
  for (const ReproducedFigure& each : figures) {
    const PaperFigure& figure = each.figure;
    if (figure.source != source) {
      source = figure.source;
      text += fmt::format("{}{:<{}} {:>9} {:>11} {:>9}  {:<6} {}\n", text.empty() ? "" : "\n", source,
                          wide + 2, "paper", "as printed", "ours", "unit", "verdict");
    }
    text += fmt::format("  {:<{}} {:>9} {:>11} {:>9}  {:<6} {}\n", figure.title, wide, written(figure.paper),
                        written(each.as_printed), written(each.ours), figure.unit, word(each.outcome));
    if (each.outcome == Outcome::not_reached && !figure.reason.empty())
      text += fmt::format("    {}\n", figure.reason);
  }
  return text + "\n" + counts(figures) + "\n";
}

std::string reproduction_json(const Reproduction& reproduction) {
  FiguresJson entries = FiguresJson::array();
  for (const ReproducedFigure& each : reproduction.figures) entries.push_back(entry_json(each));
  return json_text(FiguresJson{{"entries", entries}});
}

std::string reproduction_page(const Reproduction& reproduction, const std::string& call) {
  FiguresJson entries = FiguresJson::array(), pictures = FiguresJson::array();
  for (const ReproducedFigure& each : reproduction.figures) entries.push_back(page_entry_json(each));
  for (const DrawnPicture& each : reproduction.pictures) pictures.push_back(picture_json(each));
  const FiguresJson data = {{"summary", counts(reproduction.figures)},
                            {"entries", entries},
                            {"pictures", pictures},
                            {"call", call},
                            {"version", "flinch " FLINCH_VERSION}};
  return std::string(reproduction_page_template_before_data) + inside_script(json_text(data)) +
         std::string(reproduction_page_template_after_data);
}

}  // namespace flinch
