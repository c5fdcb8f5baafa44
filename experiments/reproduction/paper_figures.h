#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "experiments/reproduction/signal_curve.h"

namespace flinch {

/// What is run: a scenario, a campaign, or commands.
struct RunSource {
  enum class Kind { scenario, campaign, commands };

  Kind kind = Kind::scenario;
  std::filesystem::path file;       ///< a scenario, or a campaign
  std::vector<std::string> set;     ///< values of its keys, KEY=VALUE
  std::optional<std::size_t> runs;  ///< of a campaign, at each point of its grid; none: as it says
  /// Words of each command, without the program's name; the last one prints what is asked for.
  std::vector<std::vector<std::string>> commands;

  bool operator==(const RunSource&) const = default;
};

/// Where a figure comes from: what is run, and either a place in what it says as JSON or, of a scenario, a
/// curve of its recording.
struct FigureSource {
  RunSource run;
  std::string figure;  ///< path, see figure_at()
  std::string less;    ///< path of what is taken off; "" is nothing
  std::string per;     ///< path of what it is divided by; "" is nothing
  double times = 1.0;  ///< factor
  std::optional<SignalCurve> curve;
  CurveStatistic statistic;  ///< of the curve
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

/// A line of a picture: a number of a run over time, or over another number of it.
struct PictureLine {
  std::string name;
  RunSource run;  ///< a scenario
  SignalCurve curve;
  std::optional<SignalCurve> over;  ///< none: time
};

/// Dots of a picture: the runs of a campaign, by two columns of its table.
struct PictureDots {
  std::string name;
  RunSource run;  ///< a campaign
  std::string x, y;
  std::string x_less;                   ///< column that is taken off x; "" is nothing
  double x_times = 1.0, y_times = 1.0;  ///< factors
  std::string of;                       ///< sort of body that the runs touch; "" is all
  bool with_line = false;               ///< the straight line by least squares is drawn
};

/// A matrix of shares that commands print: {"classes": [...], "rows": [[...], ...]} under a key.
struct PictureMatrix {
  RunSource run;  ///< commands
  std::string key;
};

/// A line across a picture, such as a limit.
struct PictureMark {
  std::string name;
  double at = 0.0;
  bool upright = false;  ///< at a value of x
};

/// A picture of a paper, drawn of what flinch does. Figures with the same source stand beside it.
struct PaperPicture {
  std::string id;      ///< unique: "safepr.fig9.position"
  std::string source;  ///< "[SafePR] Fig. 9"
  std::string title;
  std::string note;     ///< what the paper's picture shows, in a sentence
  std::string x_title;  ///< with its unit, of times ms
  std::string y_title;  ///< likewise
  std::vector<PictureLine> lines;
  std::vector<PictureDots> dots;
  std::vector<PictureMark> marks;
  std::optional<PictureMatrix> matrix;  ///< in the place of lines and dots
};

/// What papers show.
struct PaperFigures {
  std::vector<PaperFigure> figures;
  std::vector<PaperPicture> pictures;
};

/// Those whose id is `only`, or has it as one of its words or as several in a row. Throws SetupError naming
/// the nearest where there are none.
PaperFigures figures_called(const PaperFigures& all, const std::string& only);

}  // namespace flinch
