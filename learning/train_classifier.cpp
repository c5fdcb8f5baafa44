#include "learning/train_classifier.h"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <exception>
#include <map>
#include <mutex>
#include <set>
#include <thread>

#include "learning/folds.h"
#include "systems/contact/wrench_uncertainty.h"
#include "systems/foundation/nearest_name.h"
#include "systems/foundation/setup_error.h"

namespace flinch {
namespace {

const std::vector<std::string> folds_names = {"run", "configuration"};

/// The fold of each question. What is kept together, a run or a configuration, is dealt out.
std::vector<int> folds_of(const Questions& questions, const DataSet& data, const ClassifierTraining& training,
                          std::uint64_t seed) {
  std::vector<int> groups = questions.set.groups;
  if (training.folds_by == FoldsBy::configuration) {
    std::transform(questions.samples.begin(), questions.samples.end(), groups.begin(),
                   [&data](std::size_t sample) { return data.samples[sample].configuration; });
  }
  return folds_of_groups(groups, training.folds, seed, name_of(training.folds_by) + "s");
}

Questions in_fold(const Questions& questions, const std::vector<int>& fold, int number, bool is_in) {
  std::vector<std::size_t> picked;
  for (std::size_t i = 0; i < fold.size(); ++i)
    if ((fold[i] == number) == is_in) picked.push_back(i);
  Questions result;
  result.set = chosen(questions.set, picked);
  for (const std::size_t i : picked) result.samples.push_back(questions.samples[i]);
  return result;
}

/// Does `jobs` on several threads; each is told how to say how far it is.
void in_parallel(std::size_t jobs, std::size_t threads, const TrainingProgress& progress,
                 const std::function<void(std::size_t job, const TrainingProgress&)>& job) {
  std::mutex mutex;
  std::vector<double> shares(jobs, 0.0);
  std::atomic<std::size_t> next = 0;
  std::atomic<bool> ended = false;
  std::exception_ptr problem;
  const auto work = [&] {
    try {
      for (std::size_t i = next++; i < jobs && !ended; i = next++) {
        job(i, [&, i](double share) {
          const std::lock_guard lock(mutex);
          shares[i] = share;
          double done = 0.0;
          for (const double each : shares) done += each;
          if (progress && !progress(done / static_cast<double>(jobs))) ended = true;
          return !ended.load();
        });
      }
    } catch (...) {
      const std::lock_guard lock(mutex);
      if (!problem) problem = std::current_exception();
      ended = true;
    }
  };
  {
    std::vector<std::jthread> workers;
    for (std::size_t i = 0; i < std::min(jobs, threads); ++i) workers.emplace_back(work);
  }
  if (problem) std::rethrow_exception(problem);
}

/// Mean of -ln of the probability of what is right, where all scores are divided by `temperature`.
double cross_entropy(const std::vector<Answered>& answers, double temperature) {
  double sum = 0.0;
  for (const Answered& answer : answers) {
    if (answer.probability.size() == 0) continue;
    const Eigen::ArrayXd scores = answer.probability.array().max(1e-300).log() / temperature;
    const double top = scores.maxCoeff();
    sum += top + std::log((scores - top).exp().sum()) - scores[answer.right];
  }
  return sum / std::max(static_cast<double>(answers.size()), 1.0);
}

/// Mean over the classes of -ln of the probability of what is right.
double balanced_cross_entropy(const std::vector<Answered>& answers) {
  std::map<int, std::vector<Answered>> by_class;
  for (const Answered& answer : answers) by_class[answer.right].push_back(answer);
  double sum = 0.0;
  for (const auto& [right, of_class] : by_class) sum += cross_entropy(of_class, 1.0);
  return sum / std::max(static_cast<double>(by_class.size()), 1.0);
}

/// The temperature of least cross-entropy: golden section over its logarithm, in which that has one minimum.
double best_temperature(const std::vector<Answered>& answers) {
  const double golden = 0.5 * (std::sqrt(5.0) - 1.0);
  double low = std::log(0.2), high = std::log(5.0);
  for (int i = 0; i < 40; ++i) {
    const double a = high - golden * (high - low), b = low + golden * (high - low);
    if (cross_entropy(answers, std::exp(a)) < cross_entropy(answers, std::exp(b)))
      high = b;
    else
      low = a;
  }
  return std::exp(0.5 * (low + high));
}

void divide_scores(NetworkParameters& network, double temperature) {
  network.layers.back().weights /= temperature;
  network.layers.back().bias /= temperature;
}

std::vector<Answered> at_temperature(std::vector<Answered> answers, double temperature) {
  for (Answered& answer : answers) {
    if (answer.probability.size() == 0) continue;
    answer.probability = answer.probability.array().max(1e-300).pow(1.0 / temperature).matrix();
    answer.probability /= answer.probability.sum();
  }
  return answers;
}

double accuracy_of(const std::vector<Answered>& answers, const FeatureSet& features) {
  return evaluate(answers, features, 0.0, "").confusion.balanced_accuracy().value_or(0.0);
}

void describe(const DataSet& data, const ClassifierTraining& training, const FeatureSet& features,
              TrainedClassifier& result) {
  ClassifierModel& model = result.model;
  model.classes = features.classes();
  model.features = features.names();
  model.units = features.units();
  const TrainingSettings& settings = result.settings;
  const auto card = [&data](const char* key) {
    const auto found = data.card.find(key);
    return found == data.card.end() ? std::string() : found->second;
  };
  const std::string configurations = fmt::format("{}", fmt::join(training.filter.configurations, ", "));
  model.provenance = {{"question", name_of(training.question)},
                      {"robot.name", data.robot->name()},
                      {"robot.fingerprint", fingerprint(data.robot_text, data.robot_file)},
                      {"features.check", features.check()},
                      {"data.sha256", data.sha256},
                      {"data.configurations", configurations},
                      {"data.title", card("title")},
                      {"data.seed", card("seed")},
                      {"data.runs", card("runs")},
                      {"data.wrench", card("wrench")},
                      {"flinch.version", FLINCH_VERSION},
                      {"hidden_layers", fmt::format("{}", fmt::join(settings.hidden, ", "))},
                      {"l2", fmt::format("{}", settings.l2)},
                      {"learning_rate", fmt::format("{}", settings.learning_rate)},
                      {"epochs", fmt::format("{}", settings.epochs)},
                      {"batch", fmt::format("{}", settings.batch)},
                      {"folds", fmt::format("{}", training.folds)},
                      {"folds_by", name_of(training.folds_by)},
                      {"seed", fmt::format("{}", settings.seed)},
                      {"temperature", fmt::format("{:.4f}", result.temperature)},
                      {"cross_validated_accuracy",
                       fmt::format("{:.4f}", result.expected.confusion.balanced_accuracy().value_or(0.0))}};
  if (settings.least_scale > 0.0) model.provenance["least_scale"] = fmt::format("{}", settings.least_scale);
}

}  // namespace

std::string name_of(FoldsBy folds_by) { return folds_names[static_cast<std::size_t>(folds_by)]; }

FoldsBy folds_by_named(const std::string& name) {
  const auto found = std::find(folds_names.begin(), folds_names.end(), name);
  if (found == folds_names.end())
    throw SetupError("'" + name + "' is neither run nor configuration" + did_you_mean(name, folds_names));
  return static_cast<FoldsBy>(found - folds_names.begin());
}

TrainingSettings standard_settings(Question question) {
  TrainingSettings settings;
  switch (question) {
    case Question::touched:
      return settings;
    case Question::body:
      settings.hidden = {30, 30, 30, 30};
      break;
    case Question::clamping:
      settings.hidden = {30, 30, 30, 30, 30};
      break;
    case Question::chain:
      settings.hidden = {25, 25, 25, 25, 25};
      break;
  }
  settings.l2 = 1e-4;
  settings.learning_rate = 1e-3;
  return settings;
}

SearchedSettings searched_settings(Question question) {
  if (question == Question::touched) return {{TrainingSettings().epochs}, {TrainingSettings().l2}};
  return {{10, 20, 40}, {1e-4, 1e-3, 1e-2}};
}

std::vector<TrainingSettings> combinations(const TrainingSettings& base, const SearchedSettings& searched) {
  std::vector<TrainingSettings> all;
  for (const int epochs : searched.epochs) {
    for (const double l2 : searched.l2) {
      TrainingSettings& settings = all.emplace_back(base);
      settings.epochs = epochs;
      settings.l2 = l2;
    }
  }
  return all;
}

std::vector<TrainingSettings> paper_grid(const TrainingSettings& base) {
  std::vector<TrainingSettings> grid;
  for (const std::size_t layers : {2U, 3U, 4U, 5U}) {
    for (const int width : {10, 15, 20, 25, 30}) {
      for (const double l2 : {1e-4, 1e-3, 1e-2, 1e-1}) {
        TrainingSettings& settings = grid.emplace_back(base);
        settings.hidden.assign(layers, width);
        settings.l2 = l2;
      }
    }
  }
  return grid;
}

double least_wrench_of(const DataSet& data, const std::vector<std::size_t>& samples) {
  std::vector<double> sizes;
  for (const std::size_t sample : samples)
    sizes.push_back(WrenchUncertainty().size(data.robot->space(), data.samples[sample].wrench_in_base()));
  if (sizes.empty()) return 0.0;
  const auto twentieth = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 20);
  std::nth_element(sizes.begin(), twentieth, sizes.end());
  return *twentieth;
}

TrainedClassifier train_classifier(const DataSet& data, const ClassifierTraining& training,
                                   const TrainingProgress& progress) {
  std::vector<TrainingSettings> candidates = training.candidates;
  if (candidates.empty()) candidates.push_back(standard_settings(training.question));
  const std::size_t threads =
      training.threads != 0 ? training.threads : std::max(1U, std::thread::hardware_concurrency());
  const FeatureSet features(training.question, data.robot);
  const bool balanced = training.question != Question::touched;
  const Questions questions = questions_of(data, features, training.filter, balanced, threads);
  if (std::set<int>(questions.set.answers.begin(), questions.set.answers.end()).size() < 2) {
    throw SetupError("the data hold fewer than two of the classes that '" + name_of(training.question) +
                     "' is about");
  }
  const std::vector<int> fold = folds_of(questions, data, training, candidates.front().seed);
  const auto folds = static_cast<std::size_t>(training.folds);

  std::vector<std::vector<Answered>> parts(candidates.size() * folds);
  in_parallel(
      parts.size(), threads, [&](double share) { return !progress || progress(0.8 * share); },
      [&](std::size_t job, const TrainingProgress& said) {
        const int number = static_cast<int>(job % folds);
        const Questions taught = in_fold(questions, fold, number, false);
        const NeuralNetwork network(
            train_network(taught.set, features.outputs(), candidates[job / folds], said));
        parts[job] = answers_of(network, in_fold(questions, fold, number, true), data);
      });
  TrainedClassifier result;
  std::vector<Answered> best;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    std::vector<Answered> answers;
    for (std::size_t j = 0; j < folds; ++j)
      answers.insert(answers.end(), parts[i * folds + j].begin(), parts[i * folds + j].end());
    result.accuracies.push_back(accuracy_of(answers, features));
    result.losses.push_back(balanced_cross_entropy(answers));
    if (result.losses.back() == *std::min_element(result.losses.begin(), result.losses.end())) {
      result.settings = candidates[i];
      best = std::move(answers);
    }
  }
  result.temperature = best_temperature(best);
  best = at_temperature(std::move(best), result.temperature);
  result.model.accepted_from = acceptance_for(best, training.wrong_of_accepted);
  if (training.question == Question::touched)
    result.model.least_wrench = least_wrench_of(data, questions.samples);
  disbelieve_small(best, data, result.model.least_wrench);
  result.expected = evaluate(best, features, result.model.accepted_from, "cross-validation");
  result.model.network = train_network(questions.set, features.outputs(), result.settings, [&](double share) {
    return !progress || progress(0.8 + 0.2 * share);
  });
  divide_scores(result.model.network, result.temperature);
  describe(data, training, features, result);
  return result;
}

}  // namespace flinch
