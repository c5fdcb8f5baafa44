#include "learning/evaluation.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "systems/contact/wrench_uncertainty.h"
#include "systems/foundation/setup_error.h"

namespace flinch {
namespace {

bool is_right(const Answered& answer) { return answer.given() == answer.right; }

/// Which part of the classes each class is in: 0, 1, ... ; -1: none.
std::vector<int> part_of(const std::vector<std::string>& classes, const std::string& ending) {
  std::vector<int> part;
  int next = 0;
  for (const std::string& name : classes) part.push_back(name.ends_with(ending) ? next++ : -1);
  return part;
}

std::optional<double> share_right(const Confusion& confusion, Eigen::Index row) {
  const double all = confusion.counts.row(row).sum();
  return all > 0.0 ? std::optional(confusion.counts(row, row) / all) : std::nullopt;
}

void add_tasks(const std::vector<Answered>& answers, const FeatureSet& features, Evaluation& result) {
  const Question question = features.question();
  const std::vector<std::string>& classes = features.classes();
  const bool is_touched = question == Question::touched;
  if (question == Question::body) result.body = result.confusion.balanced_accuracy();
  if (question == Question::chain) result.chain = result.confusion.balanced_accuracy();
  Confusion two = result.confusion;
  if (is_touched) {
    std::vector<int> body, chain = part_of(classes, "_clamping"), clamping;
    std::vector<std::string> bodies, chains;
    for (std::size_t i = 0; i < classes.size(); ++i) {
      body.push_back(chain[i] < 0 ? static_cast<int>(bodies.size()) : -1);
      clamping.push_back(chain[i] < 0 ? 0 : 1);
      (chain[i] < 0 ? bodies : chains).push_back(classes[i]);
    }
    result.body = confusion_of(answers, bodies, body).balanced_accuracy();
    result.chain = confusion_of(answers, chains, chain).balanced_accuracy();
    two = confusion_of(answers, {"collision", "clamping"}, clamping);
  }
  if (!is_touched && question != Question::clamping) return;
  result.collision_clamping = two.balanced_accuracy();
  result.collision = share_right(two, 0);
  result.clamping = share_right(two, 1);
}

std::vector<int> themselves(std::size_t count) {
  std::vector<int> of(count);
  for (std::size_t i = 0; i < count; ++i) of[i] = static_cast<int>(i);
  return of;
}

/// The surest first.
std::vector<const Answered*> by_confidence(const std::vector<Answered>& answers) {
  std::vector<const Answered*> order;
  for (const Answered& answer : answers) order.push_back(&answer);
  std::stable_sort(order.begin(), order.end(),
                   [](const Answered* a, const Answered* b) { return a->confidence() > b->confidence(); });
  return order;
}

/// How many of the first 0, 1, 2, ... are wrong.
std::vector<double> errors_among(const std::vector<const Answered*>& order) {
  std::vector<double> errors(order.size() + 1, 0.0);
  for (std::size_t i = 0; i < order.size(); ++i)
    errors[i + 1] = errors[i] + (is_right(*order[i]) ? 0.0 : 1.0);
  return errors;
}

RejectPoint reject_last(const std::vector<const Answered*>& order, const std::vector<double>& errors,
                        double rejected) {
  const auto all = static_cast<double>(order.size());
  const auto accepted = static_cast<std::size_t>(std::ceil((1.0 - rejected) * all - 1e-9));
  if (accepted == 0) return {1.0, order.empty() ? 0.0 : 1.0, 0.0};
  const auto count = static_cast<double>(accepted);
  return {order[accepted - 1]->confidence(), 1.0 - count / all, errors[accepted] / count};
}

}  // namespace

int Answered::given() const {
  if (probability.size() == 0) return -1;
  Eigen::Index best = 0;
  probability.maxCoeff(&best);
  return static_cast<int>(best);
}

double Answered::confidence() const { return probability.size() == 0 ? 0.0 : probability.maxCoeff(); }

std::vector<Answered> answers_of(const NeuralNetwork& network, const Questions& questions,
                                 const DataSet& data) {
  const TrainingSet& set = questions.set;
  if (network.parameters().inputs() != set.inputs.rows()) {
    throw SetupError("the network takes " + std::to_string(network.parameters().inputs()) +
                     " features and is asked with " + std::to_string(set.inputs.rows()));
  }
  std::vector<Answered> answers;
  NeuralNetwork::Values outputs;
  for (std::size_t i = 0; i < set.questions(); ++i) {
    const auto first = static_cast<Eigen::Index>(i) * set.rows;
    Answered& answer = answers.emplace_back();
    answer.sample = questions.samples[i];
    answer.configuration = data.samples[answer.sample].configuration;
    answer.right = set.answers[i];
    if (network.evaluate(set.inputs.middleCols(first, set.rows).cast<double>(), outputs))
      answer.probability = outputs.reshaped();
  }
  return answers;
}

void disbelieve_small(std::vector<Answered>& answers, const DataSet& data, double least_wrench) {
  for (Answered& answer : answers) {
    const PlatformVector& wrench = data.samples[answer.sample].wrench_in_base();
    answer.believable = WrenchUncertainty().size(data.robot->space(), wrench) >= least_wrench;
  }
}

Eigen::MatrixXd Confusion::row_normalised() const {
  Eigen::MatrixXd shares = counts;
  for (auto row : shares.rowwise()) {
    if (row.sum() > 0.0) row /= row.sum();
  }
  return shares;
}

std::optional<double> Confusion::balanced_accuracy() const {
  double sum = 0.0;
  int occurring = 0;
  for (Eigen::Index row = 0; row < counts.rows(); ++row) {
    const double all = counts.row(row).sum();
    if (all == 0.0) continue;
    sum += counts(row, row) / all;
    ++occurring;
  }
  return occurring == 0 ? std::nullopt : std::optional(sum / occurring);
}

Confusion confusion_of(const std::vector<Answered>& answers, const std::vector<std::string>& classes,
                       const std::vector<int>& of) {
  const auto count = static_cast<Eigen::Index>(classes.size());
  Confusion confusion{classes, Eigen::MatrixXd::Zero(count, count), 0};
  for (const Answered& answer : answers) {
    const int right = of[static_cast<std::size_t>(answer.right)];
    if (right < 0) continue;
    if (answer.probability.size() != static_cast<Eigen::Index>(of.size())) {
      ++confusion.unanswered;
      continue;
    }
    Eigen::VectorXd sums = Eigen::VectorXd::Zero(count);
    for (std::size_t i = 0; i < of.size(); ++i) {
      if (of[i] >= 0) sums[of[i]] += answer.probability[static_cast<Eigen::Index>(i)];
    }
    Eigen::Index given = 0;
    sums.maxCoeff(&given);
    confusion.counts(right, given) += 1.0;
  }
  return confusion;
}

std::vector<ReliabilityBin> reliability_of(const std::vector<Answered>& answers, int bins) {
  std::vector<ReliabilityBin> result(static_cast<std::size_t>(bins));
  for (int i = 0; i < bins; ++i) {
    result[static_cast<std::size_t>(i)].from = static_cast<double>(i) / bins;
    result[static_cast<std::size_t>(i)].to = static_cast<double>(i + 1) / bins;
  }
  for (const Answered& answer : answers) {
    const int at = std::min(static_cast<int>(answer.confidence() * bins), bins - 1);
    ReliabilityBin& bin = result[static_cast<std::size_t>(at)];
    ++bin.count;
    bin.confidence += answer.confidence();
    bin.accuracy += is_right(answer) ? 1.0 : 0.0;
  }
  for (ReliabilityBin& bin : result) {
    if (bin.count == 0) continue;
    bin.confidence /= static_cast<double>(bin.count);
    bin.accuracy /= static_cast<double>(bin.count);
  }
  return result;
}

double expected_calibration_error(const std::vector<ReliabilityBin>& bins) {
  double sum = 0.0, count = 0.0;
  for (const ReliabilityBin& bin : bins) {
    sum += static_cast<double>(bin.count) * std::abs(bin.accuracy - bin.confidence);
    count += static_cast<double>(bin.count);
  }
  return count > 0.0 ? sum / count : 0.0;
}

RejectPoint reject_at(const std::vector<Answered>& answers, double accepted_from) {
  double accepted = 0.0, wrong = 0.0;
  for (const Answered& answer : answers) {
    if (answer.given() < 0 || !answer.believable || answer.confidence() < accepted_from) continue;
    accepted += 1.0;
    wrong += is_right(answer) ? 0.0 : 1.0;
  }
  const double all = std::max(static_cast<double>(answers.size()), 1.0);
  return {accepted_from, 1.0 - accepted / all, accepted > 0.0 ? wrong / accepted : 0.0};
}

RejectPoint reject_share(const std::vector<Answered>& answers, double rejected) {
  const std::vector<const Answered*> order = by_confidence(answers);
  return reject_last(order, errors_among(order), rejected);
}

std::vector<RejectPoint> reject_curve(const std::vector<Answered>& answers) {
  const std::vector<const Answered*> order = by_confidence(answers);
  const std::vector<double> errors = errors_among(order);
  std::vector<RejectPoint> curve;
  for (int i = 0; i < 100; ++i) curve.push_back(reject_last(order, errors, 0.01 * i));
  return curve;
}

double acceptance_for(const std::vector<Answered>& answers, double wrong) {
  const std::vector<const Answered*> order = by_confidence(answers);
  const std::vector<double> errors = errors_among(order);
  double least = 1.0;
  for (std::size_t i = 0; i < order.size(); ++i) {
    if (errors[i + 1] <= wrong * static_cast<double>(i + 1)) least = order[i]->confidence();
  }
  return least;
}

Evaluation evaluate(const std::vector<Answered>& answers, const FeatureSet& features, double accepted_from,
                    const std::string& moment) {
  Evaluation result;
  result.moment = moment;
  result.samples = answers.size();
  const std::vector<int> own = themselves(features.classes().size());
  result.confusion = confusion_of(answers, features.classes(), own);
  std::map<int, std::vector<Answered>> by_configuration;
  for (const Answered& answer : answers) by_configuration[answer.configuration].push_back(answer);
  if (by_configuration.size() <= 10) {
    for (const auto& [configuration, of_it] : by_configuration)
      result.by_configuration.emplace_back(configuration, confusion_of(of_it, features.classes(), own));
  }
  add_tasks(answers, features, result);
  result.reliability = reliability_of(answers);
  result.calibration_error = expected_calibration_error(result.reliability);
  result.rejects = reject_curve(answers);
  result.accepted = reject_at(answers, accepted_from);
  result.at_tenth = reject_share(answers, 0.1);
  return result;
}

}  // namespace flinch
