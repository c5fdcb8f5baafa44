#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "experiments/reproduction/paper_figures.h"

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

/// "reproduced", "better", "not reached".
const char* word(ReproducedFigure::Outcome outcome);

/// `figure` with these values, judged.
ReproducedFigure judged(const PaperFigure& figure, std::optional<double> as_printed,
                        std::optional<double> ours);

/// Told now and then which share of the runs is done. Returns false to stop: what is done is kept.
using ReproductionProgress = std::function<bool(double share)>;

/// Runs the scenarios and campaigns of all `figures`, each once, on `threads` threads (0: one a processor).
/// Campaigns keep their results in folders of `folder`, from which the same call goes on. Throws SetupError
/// with what is wrong with any of their files, before any run, and where it was stopped.
std::vector<ReproducedFigure> reproduce(const std::vector<PaperFigure>& figures,
                                        const std::filesystem::path& folder, std::size_t threads = 0,
                                        const ReproductionProgress& progress = {});

/// The figures as a table for people, as one JSON object on one line, {"entries": [...]}, and as one HTML
/// page that needs nothing else. `call`: the command that made them.
std::string reproduction_table(const std::vector<ReproducedFigure>& figures);
std::string reproduction_json(const std::vector<ReproducedFigure>& figures);
std::string reproduction_page(const std::vector<ReproducedFigure>& figures, const std::string& call);

}  // namespace flinch
