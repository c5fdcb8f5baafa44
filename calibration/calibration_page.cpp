#include "calibration/calibration_page.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "calibration/calibration_result.h"
#include "calibration/page_drawing.h"
#include "systems/foundation/html_page.h"

namespace flinch {
namespace {

constexpr std::size_t most_ellipses = 6;
constexpr double one_and_the_same = 0.99999;  // correlation of what follows from one another

constexpr const char* style = R"css(
:root{color-scheme:light dark;--paper:#f8f7f3;--panel:#fff;--ink:#1d2328;--soft:#5a646d;--line:#d9dbd6;
--grid:#eceeea;--before:#c13a2866;--after:#1b5e9b;--good:#1a7040;--bad:#b02a1c}
@media(prefers-color-scheme:dark){:root{--paper:#14171a;--panel:#1b1f23;--ink:#e6e8e9;--soft:#9ba6af;
--line:#343b41;--grid:#262b30;--before:#ff7b6677;--after:#6fb5f3;--good:#63cf95;--bad:#ff8a7a}}body{
margin:0 auto;max-width:1200px;padding:1.5rem;background:var(--paper);color:var(--ink);
font:15px/1.45 system-ui,"Noto Sans","Liberation Sans",sans-serif}h1{
font:600 1.7rem Charter,Georgia,"Liberation Serif",serif;margin:.2rem 0}h2{font-size:1.1rem;
margin:1.8rem 0 .5rem}.soft{color:var(--soft)}.warning{color:var(--bad);margin:.3rem 0}table{
border-collapse:collapse;background:var(--panel)}th,td{padding:.25rem .7rem;
border-bottom:1px solid var(--line);text-align:right;font-variant-numeric:tabular-nums}
th:first-child,td:first-child{text-align:left}.scroll{overflow-x:auto}.drawings{display:grid;
grid-template-columns:repeat(auto-fill,minmax(330px,1fr));gap:1rem}svg{background:var(--panel);
border:1px solid var(--line);border-radius:6px;width:100%;height:auto}text{fill:var(--ink);
font-size:10px}.title{font-weight:600;font-size:12px}.tick{fill:var(--soft);font-size:9px}.label{
fill:var(--soft)}.frame{fill:none;stroke:var(--line)}.grid{stroke:var(--grid)}.before,.after{fill:none;
stroke-linecap:round;stroke-width:2.4}.before{stroke:var(--before)}.after{stroke:var(--after)}
.ellipse,.whisker{fill:none;stroke:var(--after);stroke-width:1.4}.box{fill:var(--grid);
stroke:var(--after)}.median{stroke:var(--ink);stroke-width:1.6}code{font-size:.85em;
overflow-wrap:anywhere}@media(min-width:1001px){td:not(:last-child){white-space:nowrap}}
@media(max-width:1000px){table,tbody{display:block}thead{display:none}tr{display:grid;
grid-template-columns:repeat(3,auto);gap:.2rem 1rem;padding:.6rem .7rem;border-bottom:1px solid var(--line)}
td{border:0;padding:0;text-align:left}td:first-child,td:last-child{grid-column:1/-1}td[data-name]::before{
content:attr(data-name);display:block;color:var(--soft);font-size:.8rem}})css";

/// On a phone the name of its column stands above it.
std::string cell(const std::string& text, const std::string& name = "") {
  return (name.empty() ? "<td>" : "<td data-name='" + name + "'>") + text + "</td>";
}

std::string head(const std::vector<std::string>& columns) {
  std::string html = "<div class='scroll'><table><thead><tr>";
  for (const std::string& column : columns) html += "<th scope='col'>" + column + "</th>";
  return html + "</tr></thead><tbody>";
}

/// By how many of its deviations a parameter differs from what was believed; none: nobody can tell.
std::optional<double> moved(const CalibratedParameter& parameter) {
  if (!parameter.identifiable || !parameter.before || !parameter.deviation || !(*parameter.deviation > 0.0))
    return {};
  return (parameter.value - *parameter.before) / *parameter.deviation;
}

/// What differs most from what was believed comes first.
std::vector<CalibratedParameter> by_change(const CalibrationResult& result) {
  std::vector<CalibratedParameter> sorted = result.parameters;
  std::stable_sort(sorted.begin(), sorted.end(), [](const auto& a, const auto& b) {
    return std::abs(moved(a).value_or(0.0)) > std::abs(moved(b).value_or(0.0));
  });
  return sorted;
}

/// In percent, two digits or, of more than ten, whole ones.
std::string change(double before, double found) {
  const double percent = 100.0 * (found / before - 1.0);
  return std::abs(percent) < 10.0 ? fmt::format("{:+.2g} %", percent) : fmt::format("{:+.0f} %", percent);
}

std::string table(const CalibrationResult& result) {
  constexpr const char* none = "–";
  std::string html =
      head({"parameter", "before", "found", "standard deviation", "unit", "change", "in deviations", ""});
  for (const CalibratedParameter& parameter : by_change(result)) {
    const bool has_share = parameter.identifiable && parameter.before && *parameter.before != 0.0;
    const std::optional<double> by = moved(parameter);
    html += "<tr>" + cell("<code>" + escaped(parameter.name) + "</code>");
    html += cell(parameter.before ? fmt::format("{:.6g}", *parameter.before) : none, "before");
    html += cell(parameter.identifiable ? fmt::format("{:.6g}", parameter.value) : none, "found");
    html += cell(parameter.deviation ? fmt::format("{:.2g}", *parameter.deviation) : none, "deviation");
    html += cell(escaped(parameter.unit), "unit");
    html += cell(has_share ? change(*parameter.before, parameter.value) : none, "change");
    html += cell(by ? fmt::format("{:+.1f}", *by) : none, "in deviations");
    html += cell(parameter.identifiable ? "" : "not identifiable: as believed before") + "</tr>";
  }
  return html + "</tbody></table></div>";
}

/// Of the pairs of parameters that the data tell, those with the strongest correlation.
std::string ellipses(const CalibrationResult& result) {
  struct Pair {
    double correlation;
    std::size_t a, b;
  };
  std::vector<Pair> pairs;
  for (std::size_t a = 0; a < result.parameters.size(); ++a) {
    for (std::size_t b = 0; b < a; ++b) {
      if (!result.parameters[a].identifiable || !result.parameters[b].identifiable) continue;
      const auto i = static_cast<Eigen::Index>(a), j = static_cast<Eigen::Index>(b);
      if (std::max(i, j) >= result.covariance.rows()) continue;
      const double scale = std::sqrt(result.covariance(i, i) * result.covariance(j, j));
      if (!(scale > 0.0)) continue;
      const double correlation = result.covariance(i, j) / scale;
      if (std::abs(correlation) < one_and_the_same) pairs.push_back({correlation, a, b});
    }
  }
  std::stable_sort(pairs.begin(), pairs.end(), [](const Pair& p, const Pair& q) {
    return std::abs(p.correlation) > std::abs(q.correlation);
  });
  pairs.resize(std::min(pairs.size(), most_ellipses));
  std::string html;
  for (const Pair& pair : pairs) {
    html += ellipse_drawing(result.parameters[pair.b].name, result.parameters[pair.a].name, pair.correlation);
  }
  return html;
}

/// By how many of its deviations each parameter moves where a recording is left out.
std::string influence(const CalibrationResult& result) {
  if (result.influence.cols() < 2 || result.influence.size() == 0) return "";
  std::string html =
      "<h2>Influence of each recording</h2><p class='soft'>By how many standard deviations a parameter "
      "changes where the recording is left out; by many, where no other tells it.</p>";
  std::vector<std::string> columns = {"parameter"};
  for (Eigen::Index g = 0; g < result.influence.cols(); ++g)
    columns.push_back(fmt::format("recording {}", g + 1));
  html += head(columns);
  for (std::size_t i = 0; i < result.parameters.size(); ++i) {
    const CalibratedParameter& parameter = result.parameters[i];
    if (!parameter.deviation || *parameter.deviation == 0.0) continue;
    html += "<tr>" + cell("<code>" + escaped(parameter.name) + "</code>");
    for (Eigen::Index g = 0; g < result.influence.cols(); ++g) {
      const double change = result.influence(static_cast<Eigen::Index>(i), g) / *parameter.deviation;
      html += cell(fmt::format("{:+.{}f}", change, std::abs(change) < 10.0 ? 2 : 0),
                   columns[static_cast<std::size_t>(g) + 1]);
    }
    html += "</tr>";
  }
  return html + "</tbody></table></div>";
}

std::string drawings(const std::string& title, const std::string& about, const std::string& svg) {
  if (svg.empty()) return "";
  return "<h2>" + title + "</h2><p class='soft'>" + about + "</p><div class='drawings'>" + svg + "</div>";
}

std::string files(const std::string& what, const std::vector<CalibrationSource>& files) {
  if (files.empty()) return "";
  std::string html = "<p>" + what + "</p><ol>";
  for (const CalibrationSource& source : files)
    html +=
        "<li>" + escaped(source.file) + "<br><code class='soft'>" + escaped(source.sha256) + "</code></li>";
  return html + "</ol>";
}

std::string sources(const CalibrationResult& result, const std::string& date) {
  return "<h2>How it was made</h2>" + files("Recordings", result.recordings) +
         files("Recordings that were not used, but for the errors above", result.unseen) +
         files("Parameter files that it rests on", result.with) +
         files("Robot file", {{result.robot_file, result.robot_sha256}}) +
         "<p class='soft'>flinch " FLINCH_VERSION ", " + escaped(date) + "</p>";
}

}  // namespace

std::string calibration_page(const CalibrationResult& result, const std::string& date) {
  const std::string title = "Calibration: " + result.kind;
  std::string html = page_head(title, style);
  html += "<header><p class='soft'>flinch</p><h1>" + escaped(title) + "</h1>";
  const std::string unit = escaped(behind_residual(result.residual_unit));
  html += fmt::format(
      "<p>What is left unexplained: <b>{:.4g}{}</b> with what was believed, <b>{:.4g}{}</b> with what "
      "was found (root mean square).</p></header>",
      result.residual_before, unit, result.residual_after, unit);
  for (const std::string& contradiction : result.contradictions)
    html += "<p class='warning'>" + escaped(contradiction) + "</p>";
  for (const std::string& warning : result.warnings)
    html += "<p class='warning'>" + escaped(warning) + "</p>";
  for (const std::string& note : result.notes) html += "<p>" + escaped(note) + "</p>";
  html += "<h2>Parameters</h2>" + table(result);
  std::string residuals;
  for (const CalibrationPlot& plot : result.plots) residuals += scatter_drawing(plot);
  html += drawings("Residuals", "Pale red: with what was believed. Blue: with what was found.", residuals);
  html += drawings("Errors on recordings that were not used", "Least, quartiles, median and most.",
                   box_drawing(result.validation, result.validation_unit));
  html += drawings(
      "Parameters that go together",
      "Ellipses of one and two standard deviations of the pairs with the strongest correlation, each axis "
      "in its own deviation.",
      ellipses(result));
  html += influence(result) + sources(result, date);
  return html + "</body></html>\n";
}

}  // namespace flinch
