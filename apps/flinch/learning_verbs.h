#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "apps/flinch/command_line.h"
#include "experiments/scenario/calibration_warnings.h"

namespace flinch {

struct Scenario;

struct DatasetOptions {
  CommonOptions common;
  std::filesystem::path spec;
  std::filesystem::path out;  ///< empty: out/NAME.h5
  std::optional<std::size_t> runs;
  std::optional<std::uint64_t> seed;
  std::optional<std::size_t> threads;
  bool fresh = false;  ///< whatever is there of it already
};

struct TrainOptions {
  CommonOptions common;
  std::filesystem::path data;
  std::filesystem::path out;
  std::string question = "touched";
  std::vector<int> hidden;
  std::vector<double> l2;  ///< likewise
  std::optional<double> least_scale;
  std::optional<double> learning_rate;
  std::vector<int> epochs;  ///< of several the best; none: as searched_settings(), with `grid` 40
  std::optional<std::uint64_t> seed;
  std::optional<std::size_t> threads;
  std::vector<int> configurations;
  int folds = 5;
  std::string folds_by = "run";
  bool grid = false;
};

struct EvaluateOptions {
  CommonOptions common;
  std::filesystem::path model;
  std::filesystem::path data;
  std::filesystem::path out;  ///< of the page; empty: beside the data
  std::string at;             ///< which samples; empty: as the data set is meant
  std::vector<int> configurations;
  std::optional<std::size_t> threads;
};

ExitStatus dataset(const DatasetOptions& options);
ExitStatus train(const TrainOptions& options);
ExitStatus evaluate(const EvaluateOptions& options);

/// Throw SetupError for all that is wrong with a file of this kind, and where this program was built without
/// what reads it.
void check_classifier(const std::filesystem::path& model);
void check_data_set(const std::filesystem::path& data);
std::vector<CalibrationWarning> check_data_spec(const std::filesystem::path& spec);

/// follow_networks(), and what stands in for it where this program was built without what reads networks.
std::function<void(Scenario&)> classifier_of(const std::vector<std::filesystem::path>& models);

/// Lets scenario files name "papers_networks" and "learned_classifier".
void add_network_stages();

}  // namespace flinch
