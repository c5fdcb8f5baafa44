#include "learning/evaluation_page.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "learning/page/style.h"
#include "systems/foundation/html_page.h"
#include "systems/foundation/result_file.h"

namespace flinch {
namespace {

std::string percent(const std::optional<double>& share, int digits = 1) {
  return share ? fmt::format("{:.{}f} %", 100.0 * *share, digits) : "–";
}

std::string figure(const std::string& value, const std::string& what) {
  return fmt::format("<div class=\"figure\"><strong>{}</strong><span class=\"soft\">{}</span></div>", value,
                     what);
}

std::string figures_of(const Evaluation& chosen) {
  std::string html = "<div class=\"figures\">";
  if (chosen.body) html += figure(percent(chosen.body), "of collisions: the right body");
  if (chosen.collision) html += figure(percent(chosen.collision), "of collisions told from clampings");
  if (chosen.clamping) html += figure(percent(chosen.clamping), "of clampings told as such");
  if (chosen.chain) html += figure(percent(chosen.chain), "of clampings: the right leg");
  html += figure(fmt::format("{:.4f}", chosen.calibration_error), "expected calibration error");
  html += figure(percent(chosen.accepted.rejected), "rejected");
  html += figure(percent(chosen.accepted.wrong_of_accepted, 2), "wrong of what is acted upon");
  html += figure(percent(chosen.at_tenth.wrong_of_accepted, 2), "wrong, were one in ten rejected");
  return html + "</div>\n";
}

std::string moments_table(const std::vector<Evaluation>& all) {
  std::string html =
      "<table><thead><tr><th></th><th>samples</th><th>body</th><th>collision</th><th>clamping</th><th>leg</"
      "th>"
      "<th>all classes</th><th>calibration error</th><th>rejected</th><th>wrong of "
      "accepted</th><th>wrong at 10 % rejected</th></tr></thead><tbody>\n";
  for (const Evaluation& each : all) {
    html += fmt::format("<tr><th>{}</th><td>{}</td>", each.moment, each.samples);
    for (const auto& share :
         {each.body, each.collision, each.clamping, each.chain, each.confusion.balanced_accuracy()})
      html += fmt::format("<td>{}</td>", percent(share));
    html += fmt::format("<td>{:.4f}</td><td>{}</td><td>{}</td><td>{}</td></tr>\n", each.calibration_error,
                        percent(each.accepted.rejected), percent(each.accepted.wrong_of_accepted, 2),
                        percent(each.at_tenth.wrong_of_accepted, 2));
  }
  return html + "</tbody></table>\n";
}

std::string confusion_html(const Confusion& confusion) {
  std::string html = "<div class=\"scroll\"><table><thead><tr><th>touched \\ told as</th>";
  for (const std::string& name : confusion.classes) html += "<th>" + escaped(name) + "</th>";
  html += "<th>samples</th></tr></thead><tbody>\n";
  const Eigen::MatrixXd shares = confusion.row_normalised();
  for (Eigen::Index row = 0; row < shares.rows(); ++row) {
    html += "<tr><th>" + escaped(confusion.classes[static_cast<std::size_t>(row)]) + "</th>";
    for (Eigen::Index column = 0; column < shares.cols(); ++column) {
      const double share = shares(row, column);
      const char* const colour = row == column ? "--estimate" : "--true";
      html += fmt::format(
          "<td class=\"cell{}\" style=\"background: color-mix(in srgb, var({}) {:.0f}%, "
          "transparent)\">{}</td>",
          share == 0.0 ? " none" : "", colour, 70.0 * std::sqrt(share),
          share == 0.0 ? "·" : fmt::format("{:.1f} %", 100.0 * share));
    }
    html += fmt::format("<td>{:.0f}</td></tr>\n", confusion.counts.row(row).sum());
  }
  return html + "</tbody></table></div>\n";
}

/// A square chart of shares with axes from 0 to the largest values.
class Chart {
 public:
  Chart(double width, double height, const std::string& label) : width_(width), height_(height) {
    svg_ = fmt::format("<svg viewBox=\"-20 0 480 380\" role=\"img\" aria-label=\"{}\">\n", label);
    svg_ += "<path class=\"axis\" d=\"M60 20V330H440\"/>\n";
    for (int i = 0; i <= 4; ++i) {
      text(x(width_ * i / 4), 350, "middle", fmt::format("{:.3g} %", 100.0 * width_ * i / 4));
      text(52, y(height_ * i / 4) + 4, "end", fmt::format("{:.3g} %", 100.0 * height_ * i / 4));
    }
  }
  double x(double share) const { return 60.0 + 380.0 * std::min(share / width_, 1.0); }
  double y(double share) const { return 330.0 - 310.0 * std::min(share / height_, 1.0); }
  void text(double at_x, double at_y, const char* anchor, const std::string& words) {
    svg_ += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\">{}</text>\n", at_x, at_y, anchor,
                        words);
  }
  void add(const std::string& element) { svg_ += element + "\n"; }
  std::string finish(const std::string& along, const std::string& up) {
    text(250, 374, "middle", along);
    add(fmt::format("<text transform=\"translate(-8 175) rotate(-90)\" text-anchor=\"middle\">{}</text>",
                    up));
    return svg_ + "</svg>\n";
  }

 private:
  double width_, height_;
  std::string svg_;
};

std::string reliability_chart(const Evaluation& chosen) {
  Chart chart(1.0, 1.0, "Reliability diagram");
  for (const ReliabilityBin& bin : chosen.reliability) {
    if (bin.count == 0) continue;
    chart.add(fmt::format(
        "<rect class=\"column\" x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\">"
        "<title>{} answers of {:.1f} % confidence, {:.1f} % right</title></rect>",
        chart.x(bin.from) + 2, chart.y(bin.accuracy), chart.x(bin.to) - chart.x(bin.from) - 4,
        chart.y(0.0) - chart.y(bin.accuracy), bin.count, 100.0 * bin.confidence, 100.0 * bin.accuracy));
    chart.add(fmt::format("<circle class=\"point\" cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"4\"/>",
                          chart.x(bin.confidence), chart.y(bin.accuracy)));
  }
  chart.add(fmt::format("<path class=\"ideal\" d=\"M{:.1f} {:.1f}L{:.1f} {:.1f}\"/>", chart.x(0), chart.y(0),
                        chart.x(1), chart.y(1)));
  return chart.finish("probability that it gives", "how often it was right");
}

/// The least of the axes that have four round steps and reach `share`.
double round_axis(double share) {
  constexpr std::array steps{0.001, 0.0025, 0.005, 0.0075, 0.01, 0.0125, 0.015, 0.02, 0.025, 0.05, 0.1};
  for (const double step : steps)
    if (4.0 * step >= share) return 4.0 * step;
  return 1.0;
}

std::string reject_chart(const Evaluation& chosen) {
  // Beyond it there is nothing to see, unless the model itself rejects more.
  const double widest = chosen.accepted.rejected > 0.4 ? 1.0 : 0.4;
  double highest = 0.0;
  for (const RejectPoint& point : chosen.rejects) highest = std::max(highest, point.wrong_of_accepted);
  Chart chart(widest, round_axis(highest), "Reject curve");
  std::string path;
  for (const RejectPoint& point : chosen.rejects) {
    if (point.rejected > widest) break;
    path += fmt::format("{}{:.1f} {:.1f}", path.empty() ? 'M' : 'L', chart.x(point.rejected),
                        chart.y(point.wrong_of_accepted));
  }
  chart.add("<path class=\"curve\" d=\"" + path + "\"/>");
  chart.add(
      fmt::format("<circle class=\"point\" cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"5\"><title>accepted from "
                  "{:.3f}</title></circle>",
                  chart.x(chosen.accepted.rejected), chart.y(chosen.accepted.wrong_of_accepted),
                  chosen.accepted.accepted_from));
  return chart.finish("rejected", "wrong of what is accepted");
}

std::string card_of(const std::map<std::string, std::string>& values) {
  std::string html = "<dl class=\"made\">";
  for (const auto& [key, value] : values) {
    if (key == "counts" || key.ends_with(".text") || value.empty()) continue;
    html += "<dt>" + escaped(key) + "</dt><dd>" + escaped(value) + "</dd>\n";
  }
  return html + "</dl>\n";
}

std::string confusions(const Evaluation& chosen) {
  std::string html =
      "<section><h2>What was touched, and what it was told as</h2>\n" + confusion_html(chosen.confusion);
  if (chosen.by_configuration.size() > 1) {
    html +=
        "<p class=\"soft\">Configurations have the numbers that the specification of the data gives them: "
        "places on "
        "the axis of a campaign that <code>configuration</code> names, from 0, or those of recordings.</p>\n";
    for (const auto& [configuration, confusion] : chosen.by_configuration) {
      html += fmt::format("<h2>Configuration {}: {}</h2>\n", configuration,
                          percent(confusion.balanced_accuracy()));
      html += confusion_html(confusion);
    }
  }
  return html + "</section>\n";
}

}  // namespace

std::string evaluation_page(const EvaluationPage& page) {
  const auto title = page.data.card.find("title");
  const std::string name = title == page.data.card.end() ? page.data.robot_file : title->second;
  std::string html = page_head("flinch evaluation", evaluation_page_style);
  html +=
      "<header><div class=\"headline\"><p class=\"overline\">flinch · evaluation of a "
      "classifier</p><h1>";
  html += escaped(name) + "</h1><p class=\"soft\">" +
          escaped(fmt::format("{} samples of {}; decided {}", page.chosen.samples, page.data.robot->name(),
                              page.chosen.moment == "all" ? "at every sample" : page.chosen.moment)) +
          "</p></div></header>\n<main>\n<section>" + figures_of(page.chosen) + "<div class=\"scroll\">" +
          moments_table(page.all) +
          "</div><p class=\"soft\">Accuracies are means over the classes. Early: when a detector on the "
          "estimator <code>samples.early_by</code> detects the contact; detected: when the robot's does; "
          "later: 10 ms after that; all: every sample.</p></section>\n";
  html += confusions(page.chosen);
  html +=
      "<section class=\"pair\"><figure><figcaption>Reliability: right answers by the probability that they "
      "were "
      "given</figcaption>" +
      reliability_chart(page.chosen) +
      "</figure><figure><figcaption>Rejecting: the less is accepted, the less of it is wrong</figcaption>" +
      reject_chart(page.chosen) + "</figure></section>\n";
  html += "<section class=\"pair\"><div><h2>The model</h2>" + card_of(page.model.provenance) +
          "</div><div><h2>The data</h2>" + card_of(page.data.card) + "</div></section>\n";
  return html + "</main></body></html>\n";
}

void write_evaluation_page(const EvaluationPage& page, const std::filesystem::path& file) {
  write_result(file, evaluation_page(page));
}

}  // namespace flinch
