// flinch evaluate: how well a classifier tells what was touched.
#include <fstream>

#include "apps/flinch/learning_verbs.h"
#include "apps/flinch/output_place.h"
#include "apps/flinch/printing.h"
#include "apps/flinch/progress.h"
#include "learning/evaluation_output.h"
#include "learning/evaluation_page.h"
#include "learning/model_questions.h"
#include "learning/onnx_file.h"
#include "systems/foundation/nearest_name.h"
#include "systems/foundation/problems_of_place.h"
#include "systems/foundation/setup_error.h"

namespace flinch {
namespace {

struct NamedMoment {
  std::string name;
  int moments;
};
const std::vector<NamedMoment> known_moments = {
    {"early", Moment::early}, {"detected", Moment::detected}, {"later", Moment::later}, {"all", 0}};

/// Data that keep all ticks of a contact are meant to be judged by all of them.
std::string standard_moment(const DataSet& data) {
  const auto found = data.card.find("samples");
  return found != data.card.end() && found->second == "all" ? "all" : "later";
}

void check_moment(const std::string& name) {
  std::vector<std::string> names;
  for (const NamedMoment& each : known_moments) names.push_back(each.name);
  if (std::find(names.begin(), names.end(), name) == names.end())
    throw SetupError("--at " + name + ": there is no such moment" + did_you_mean(name, names));
}

std::filesystem::path page_of(const EvaluateOptions& options) {
  if (!options.out.empty()) return options.out;
  return std::filesystem::path(options.data)
      .replace_extension()
      .concat("_" + options.model.stem().string() + ".html");
}

}  // namespace

void check_classifier(const std::filesystem::path& model) {
  const ClassifierModel read = read_onnx(model);
  out_of(model.string(), [&] { check_features(read); });
}
void check_data_set(const std::filesystem::path& data) { read_data_set(data); }

ExitStatus evaluate(const EvaluateOptions& options) {
  const std::filesystem::path page = page_of(options);
  require_output(page, {options.model, options.data}, OutputKind::page);
  if (!options.at.empty()) check_moment(options.at);
  const ClassifierModel model = read_onnx(options.model);
  const DataSet data = read_data_set(options.data);
  const FeatureSet features = out_of(options.model.string(), [&] { return features_for(model, data); });
  const std::string learned = warning_of_learned(model, data, options.configurations);
  if (!learned.empty()) print_message("warning: {}: {}\n", options.data.string(), learned);
  const NeuralNetwork network(model.network);
  const std::string moment = options.at.empty() ? standard_moment(data) : options.at;
  std::vector<Evaluation> all;
  const Evaluation* chosen = nullptr;
  {
    Progress progress("evaluating", options.common.quiet || options.common.json);
    for (const NamedMoment& each : known_moments) {
      progress.show(static_cast<double>(all.size()) / static_cast<double>(known_moments.size()));
      const Questions questions = questions_of(data, features, {each.moments, options.configurations}, false,
                                               options.threads.value_or(0));
      std::vector<Answered> answers = answers_of(network, questions, data);
      disbelieve_small(answers, data, model.least_wrench);
      all.push_back(evaluate(answers, features, model.accepted_from, each.name));
    }
  }
  for (const Evaluation& each : all)
    if (each.moment == moment) chosen = &each;
  if (chosen->samples == 0) {
    throw SetupError(options.data.string() + ": holds no sample that '" + name_of(features.question()) +
                     "' can be asked about; choose others with --at or --configurations");
  }
  print_result("{}",
               options.common.json ? evaluation_json(*chosen, all) + "\n" : evaluation_table(*chosen, all));
  write_evaluation_page({.model = model, .data = data, .chosen = *chosen, .all = all}, page);
  if (!options.common.quiet) print_message("report:    {}\n", page.string());
  return ExitStatus::done;
}

}  // namespace flinch
