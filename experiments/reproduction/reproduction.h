#pragma once

#include <optional>
#include <string>
#include <vector>

#include "experiments/reproduction/paper_figures.h"
#include "experiments/reproduction/shared_runs.h"

namespace flinch {

/// What came out of a paper's figure.
struct ReproducedFigure {
  enum class Outcome {
    reproduced,  ///< by the paper's method, within the ratio
    better,      ///< than the paper's, by its method or by ours
    not_reached,
  };
  PaperFigure figure;
  std::optional<double> as_printed,
      ours;  ///< in the figure's unit; none: nothing came out, or it has no such
  Outcome outcome = Outcome::not_reached;
  double wall = 0.0;  ///< that its runs took [s]; of runs which several figures share, each has the whole
};

/// A picture with its points: of each of its lines, and of each of its dots.
struct DrawnPicture {
  PaperPicture picture;
  std::vector<PicturePoints> lines, dots;
  PictureShares matrix;
};

/// What came out of all of them.
struct Reproduction {
  std::vector<ReproducedFigure> figures;
  std::vector<DrawnPicture> pictures;
};

/// "reproduced", "better", "not reached".
const char* word(ReproducedFigure::Outcome outcome);

/// `figure` with these values, judged.
ReproducedFigure judged(const PaperFigure& figure, std::optional<double> as_printed,
                        std::optional<double> ours);

/// Runs the scenarios, campaigns and commands of all that is wanted, each once. Throws SetupError with what
/// is wrong with any of their files, before any run, and as SharedRuns::run() does.
Reproduction reproduce(const PaperFigures& wanted, const ReproductionOptions& options);

/// The figures as a table for people, as one JSON object on one line, {"entries": [...]}, and with the
/// pictures as one HTML page that needs nothing else. `call`: the command that made them.
std::string reproduction_table(const Reproduction& reproduction);
std::string reproduction_json(const Reproduction& reproduction);
std::string reproduction_page(const Reproduction& reproduction, const std::string& call);

}  // namespace flinch
