#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace flinch {

/// Where a figure comes from: a run of a scenario or a campaign, and the place in what it says as JSON.
struct FigureSource {
  std::filesystem::path file;       ///< a scenario, or a campaign
  bool is_campaign = false;         ///< of many runs
  std::vector<std::string> set;     ///< values of its keys, KEY=VALUE
  std::optional<std::size_t> runs;  ///< of a campaign, at each point of its grid; none: as it says
  std::string figure;               ///< path, see figure_at()
  std::string less;                 ///< path of what is taken off; "" is nothing

  /// Whether both come from the same run or campaign.
  bool shares_runs_with(const FigureSource& other) const {
    return file == other.file && set == other.set && runs == other.runs;
  }
};

/// A figure that a paper prints, and how flinch gets it.
struct PaperFigure {
  enum class Better { neither, lower, higher };

  std::string id;      ///< unique, words with points between them: "safepr.table4.platform.detection"
  std::string source;  ///< "[SafePR] Table IV"
  std::string title;
  std::string unit;    ///< of all values
  double paper = 0.0;  ///< as it is printed there
  /// By the paper's own method; none where flinch has it not.
  std::optional<FigureSource> as_printed;
  std::optional<FigureSource> ours;  ///< by the best that flinch has; none: as printed
  Better better = Better::neither;
  double within = 1.3;  ///< ratio to the paper's value up to which it counts as reproduced
  std::string reason;   ///< why it is not reached, where it is not; in a sentence
};

/// Throws SetupError with all that is wrong with the file.
std::vector<PaperFigure> read_paper_figures(const std::filesystem::path& file);

/// Those whose id is `only`, or has it as one of its words or as several in a row. Throws SetupError naming
/// the nearest where there are none.
std::vector<PaperFigure> figures_called(const std::vector<PaperFigure>& figures, const std::string& only);

}  // namespace flinch
