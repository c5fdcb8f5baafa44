#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "experiments/reproduction/paper_figures.h"

namespace flinch {

/// Told now and then which share of the runs is done. Returns false to stop: what is done is kept.
using ReproductionProgress = std::function<bool(double share)>;

/// Runs a command of flinch in a folder and returns what it prints. Throws SetupError where it fails.
using RunCommand =
    std::function<std::string(const std::vector<std::string>& words, const std::filesystem::path& folder)>;

/// How figures are reproduced.
struct ReproductionOptions {
  /// For campaigns and commands; the same call goes on with what is there.
  std::filesystem::path folder = {};
  std::size_t threads = 0;  ///< runs at once; 0: one a processor
  ReproductionProgress progress = {};
  RunCommand run_command = {};  ///< none: figures of commands are refused
};

/// Points of a picture.
struct PicturePoints {
  std::vector<double> x, y;
};

/// A matrix of shares, rows by what was right, columns by what was told.
struct PictureShares {
  std::vector<std::string> classes;
  std::vector<std::vector<double>> rows;
};

/// The runs of all figures and pictures, each done once, and what they say.
class SharedRuns {
 public:
  /// Throws SetupError with what is wrong with any of their files.
  explicit SharedRuns(const PaperFigures& wanted);
  ~SharedRuns();
  SharedRuns(const SharedRuns&) = delete;
  SharedRuns& operator=(const SharedRuns&) = delete;

  /// Does all of them. Throws SetupError for numbers that no recording has, for commands that fail and where
  /// it was stopped.
  void run(const ReproductionOptions& options);

  /// The figure; none where nothing came out.
  std::optional<double> figure(const FigureSource& source) const;
  PicturePoints line(const PictureLine& line) const;
  PicturePoints dots(const PictureDots& dots) const;
  PictureShares matrix(const PictureMatrix& matrix) const;
  /// How long the runs took [s].
  double wall(const RunSource& source) const;

 private:
  struct Run;

  Run& of(const RunSource& source) const;
  void do_single_runs(const ReproductionOptions& options);
  void do_campaign(Run& run, const ReproductionOptions& options);
  void do_commands(Run& run, const ReproductionOptions& options);
  void check_curves() const;
  /// Shows how many are done, with `more` of the present ones. False: stop.
  bool show(const ReproductionOptions& options, double more = 0.0) const;

  const PaperFigures& wanted_;
  std::vector<std::unique_ptr<Run>> runs_;
  double done_ = 0.0;
};

}  // namespace flinch
