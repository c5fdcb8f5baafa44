#include "learning/feature_set.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <map>
#include <thread>

#include "systems/contact/contact_window_buffer.h"
#include "systems/contact/evidence_features.h"
#include "systems/contact/feature_extraction.h"
#include "systems/foundation/nearest_name.h"
#include "systems/foundation/setup_error.h"

namespace flinch {
namespace {

const std::vector<std::string> question_names = {"touched", "body", "clamping", "chain"};

/// [SafePR] III: wrench and distances for clampings; for bodies drive torques and angles besides.
bool is_told(Question question, const std::string& feature) {
  return question == Question::body || !(feature.starts_with("drive_torque") || feature.starts_with("angle"));
}

}  // namespace

std::string name_of(Question question) { return question_names[static_cast<std::size_t>(question)]; }

Question question_named(const std::string& name) {
  const auto found = std::find(question_names.begin(), question_names.end(), name);
  if (found == question_names.end())
    throw SetupError("'" + name + "' is no question" + did_you_mean(name, question_names));
  return static_cast<Question>(found - question_names.begin());
}

FeatureSet::FeatureSet(Question question, std::shared_ptr<const ParallelRobot> robot)
    : question_(question),
      robot_(std::move(robot)),
      touchable_(classes_of(*robot_)),
      hypotheses_(robot_, TouchHypothesesSettings()) {
  const bool is_all = question == Question::touched;
  for (const FeatureName& feature : is_all ? evidence_feature_names() : feature_names(*robot_)) {
    if (!is_all && !is_told(question, feature.name)) continue;
    names_.push_back(feature.name);
    units_.push_back(feature.unit);
  }
  if (question == Question::clamping) {
    classes_ = {"collision", "clamping"};
    return;
  }
  for (int number = 0; number < touchable_.count(); ++number) {
    if (is_all || touchable_.is_clamping(number) == (question == Question::chain))
      classes_.push_back(touchable_.name(number));
  }
}

std::optional<int> FeatureSet::answer(int touched) const {
  const bool is_clamping = touchable_.is_clamping(touched);
  switch (question_) {
    case Question::touched:
      return touched;
    case Question::clamping:
      return is_clamping ? 1 : 0;
    case Question::body:
      return is_clamping ? std::nullopt : std::optional(touched);
    case Question::chain:
      return is_clamping ? std::optional(touched - touchable_.bodies()) : std::nullopt;
  }
  return std::nullopt;
}

bool FeatureSet::inputs(const DataSample& sample, NeuralNetwork::Values& columns) const {
  Kinematics now;
  robot_->kinematics(sample.pose, sample.velocity(), now);
  const PlatformVector& wrench = sample.wrench_in_base();
  if (question_ == Question::touched) {
    const ConfigurationSpace& space = robot_->space();
    ContactEvidence whole, growth;
    const auto weigh = [&](const PlatformVector& of, ContactEvidence& evidence) {
      hypotheses_.weigh(now, of, uncertainty_.covariance(space, of), evidence);
    };
    weigh(wrench, whole);
    weigh(growth_of(sample.course), growth);
    const auto courses = leg_histories(*robot_, now, sample.course);
    if (!whole.valid || !growth.valid || !courses) return false;
    const double force = wrench.head(space.translations()).norm();
    evidence_features(touchable_, {whole, growth, *courses, force}, columns);
    return true;
  }
  WrenchEstimate estimate;
  estimate.valid = true;
  estimate.wrench_in_base = wrench;
  estimate.drive_torque = drive_torques(now, wrench);
  const ContactFeatures features = contact_features(*robot_, now, estimate, FeatureSettings());
  columns = question_ == Question::body ? feature_vector(features) : clamping_vector(features);
  return features.valid;
}

std::string FeatureSet::check() const {
  DataSample sample;
  sample.pose = robot_->home_pose();
  for (std::size_t i = 0; i < sample.course.size(); ++i) {
    const double left = 1.0 - static_cast<double>(i) / static_cast<double>(sample.course.size());
    sample.course[i] = {left * PlatformVector::LinSpaced(robot_->dof(), 30.0, 2.0),
                        (1.1 - left) * PlatformVector::Constant(robot_->dof(), 0.1)};
  }
  NeuralNetwork::Values columns;
  const bool is_told = inputs(sample, columns);
  double sum = 0.0, weight = 1.0;
  for (const double number : columns.reshaped()) sum += (weight += 0.1) * number;
  return is_told ? fmt::format("{:.6g}", sum) : "nothing";
}

bool SampleFilter::chooses(const DataSample& sample) const {
  if (moments != 0 && (sample.moment & moments) == 0) return false;
  return configurations.empty() || std::find(configurations.begin(), configurations.end(),
                                             sample.configuration) != configurations.end();
}

Questions questions_of(const DataSet& data, const FeatureSet& features, const SampleFilter& filter,
                       bool balanced, std::size_t threads) {
  std::vector<std::size_t> candidates;
  for (std::size_t i = 0; i < data.samples.size(); ++i) {
    const DataSample& sample = data.samples[i];
    if (filter.chooses(sample) && features.answer(sample.touched)) candidates.push_back(i);
  }
  std::vector<NeuralNetwork::Values> inputs(0);
  const auto rows = static_cast<Eigen::Index>(features.rows());
  const auto width = static_cast<Eigen::Index>(features.names().size());
  Eigen::MatrixXf all(width, rows * static_cast<Eigen::Index>(candidates.size()));
  std::vector<char> usable(candidates.size(), 0);
  if (threads == 0) threads = std::max(1U, std::thread::hardware_concurrency());
  {
    std::vector<std::jthread> workers;
    for (std::size_t first = 0; first < threads; ++first) {
      workers.emplace_back([&, first] {
        NeuralNetwork::Values columns;
        for (std::size_t i = first; i < candidates.size(); i += threads) {
          usable[i] = features.inputs(data.samples[candidates[i]], columns) ? 1 : 0;
          all.middleCols(static_cast<Eigen::Index>(i) * rows, rows) = columns.cast<float>();
        }
      });
    }
  }
  Questions result;
  TrainingSet whole;
  whole.rows = features.rows();
  whole.inputs = std::move(all);
  std::vector<std::size_t> kept;
  std::map<int, double> of_run, of_class;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    const DataSample& sample = data.samples[candidates[i]];
    whole.answers.push_back(*features.answer(sample.touched));
    whole.groups.push_back(sample.run);
    whole.weights.push_back(1.0F);
    if (usable[i] == 0) continue;
    kept.push_back(i);
    result.samples.push_back(candidates[i]);
    of_run[sample.run] += 1.0;
  }
  result.set = chosen(whole, kept);
  double total = 0.0;
  for (std::size_t i = 0; i < kept.size(); ++i)
    of_class[result.set.answers[i]] += 1.0 / of_run[result.set.groups[i]];
  std::vector<double> weights;
  for (std::size_t i = 0; i < kept.size(); ++i) {
    weights.push_back(1.0 / of_run[result.set.groups[i]] /
                      (balanced ? of_class[result.set.answers[i]] : 1.0));
    total += weights.back();
  }
  for (std::size_t i = 0; i < kept.size(); ++i)
    result.set.weights[i] = static_cast<float>(weights[i] * static_cast<double>(kept.size()) / total);
  return result;
}

}  // namespace flinch
