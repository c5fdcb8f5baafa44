#include "experiments/reproduction/reproduction.h"

#include <algorithm>
#include <cmath>

namespace flinch {
namespace {

/// Whether `value` is as good as the paper's, or better.
bool is_as_good(const PaperFigure& figure, std::optional<double> value) {
  if (!value) return false;
  return (figure.better == PaperFigure::Better::lower && *value <= figure.paper) ||
         (figure.better == PaperFigure::Better::higher && *value >= figure.paper);
}

bool is_near(const PaperFigure& figure, std::optional<double> value) {
  if (!value || *value * figure.paper <= 0.0) return value == figure.paper;
  return std::abs(std::log(*value / figure.paper)) <= std::log(figure.within) * (1.0 + 1e-12);
}

}  // namespace

const char* word(ReproducedFigure::Outcome outcome) {
  switch (outcome) {
    case ReproducedFigure::Outcome::reproduced:
      return "reproduced";
    case ReproducedFigure::Outcome::better:
      return "better";
    case ReproducedFigure::Outcome::not_reached:
      break;
  }
  return "not reached";
}

ReproducedFigure judged(const PaperFigure& figure, std::optional<double> as_printed,
                        std::optional<double> ours) {
  using enum ReproducedFigure::Outcome;
  ReproducedFigure result{figure, as_printed, ours, not_reached, 0.0};
  if (is_as_good(figure, as_printed) || is_as_good(figure, ours)) result.outcome = better;
  if (is_near(figure, as_printed)) result.outcome = reproduced;
  return result;
}

Reproduction reproduce(const PaperFigures& wanted, const ReproductionOptions& options) {
  SharedRuns runs(wanted);
  runs.run(options);
  Reproduction result;
  for (const PaperFigure& figure : wanted.figures) {
    std::optional<double> as_printed, ours;
    double wall = 0.0;
    if (figure.as_printed) {
      as_printed = runs.figure(*figure.as_printed);
      wall += runs.wall(figure.as_printed->run);
    }
    if (figure.ours) {
      ours = runs.figure(*figure.ours);
      wall += runs.wall(figure.ours->run);
    }
    result.figures.push_back(judged(figure, as_printed, ours));
    result.figures.back().wall = wall;
  }
  for (const PaperPicture& picture : wanted.pictures) {
    DrawnPicture& drawn = result.pictures.emplace_back(DrawnPicture{picture, {}, {}, {}});
    for (const PictureLine& line : picture.lines) drawn.lines.push_back(runs.line(line));
    for (const PictureDots& dots : picture.dots) drawn.dots.push_back(runs.dots(dots));
    if (picture.matrix) drawn.matrix = runs.matrix(*picture.matrix);
  }
  return result;
}

}  // namespace flinch
