#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "learning/classifier_model.h"
#include "learning/evaluation.h"

namespace flinch {

/// What the page of an evaluation shows.
struct EvaluationPage {
  const ClassifierModel& model;
  const DataSet& data;
  const Evaluation& chosen;
  const std::vector<Evaluation>& all;  ///< of every moment
};

/// A page of one file, without scripts: accuracies, confusion for each configuration, reliability diagram,
/// reject curve, and what model and data were made of.
std::string evaluation_page(const EvaluationPage& page);

/// Throws SetupError where the file cannot be written.
void write_evaluation_page(const EvaluationPage& page, const std::filesystem::path& file);

}  // namespace flinch
