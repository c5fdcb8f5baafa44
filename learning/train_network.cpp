#include "learning/train_network.h"

#include <dlib/dnn.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>
#include <utility>

#include "systems/foundation/findings.h"
#include "systems/foundation/setup_error.h"
#include "systems/framework/random.h"

namespace flinch {
namespace {

// ---------------------------------------------------------------- what dlib is told

struct Answer {
  int right = 0;
  float weight = 1.0F;
};

/// Cross entropy of the softmax over all outputs of all rows of a question.
class QuestionLoss {
 public:
  using training_label_type = Answer;
  using output_label_type = Answer;

  int rows = 1;

  template <class Subnet, class Iterator>
  void to_label(const dlib::tensor& /*input*/, const Subnet& /*sub*/, Iterator /*labels*/) const {}

  template <class Iterator, class Subnet>
  double compute_loss_value_and_gradient(const dlib::tensor& /*input*/, Iterator answer, Subnet& sub) const {
    const dlib::tensor& output = sub.get_output();
    dlib::tensor& gradient = sub.get_gradient_input();
    const long numbers = static_cast<long>(rows) * output.k();
    const long questions = output.num_samples() / rows;
    const float* score = output.host();
    float* slope = gradient.host_write_only();
    double loss = 0.0;
    for (long question = 0; question < questions; ++question, ++answer) {
      const Answer& wanted = *answer;
      const float scale = wanted.weight / static_cast<float>(questions);
      const float highest = *std::max_element(score, score + numbers);
      float sum = 0.0F;
      for (long i = 0; i < numbers; ++i) sum += slope[i] = std::exp(score[i] - highest);
      for (long i = 0; i < numbers; ++i) slope[i] *= scale / sum;
      loss += static_cast<double>(scale * (std::log(sum) - (score[wanted.right] - highest)));
      slope[wanted.right] -= scale;
      score += numbers;
      slope += numbers;
    }
    return loss;
  }
};

/// y = W x + b of each sample. In place of dlib's own fully connected layer, whose products go to whatever
/// BLAS is installed: that of OpenBLAS without threads finds other last digits where several threads call it.
class Dense {
 public:
  using Weights = Eigen::Map<Eigen::MatrixXf>;
  using ConstWeights = Eigen::Map<const Eigen::MatrixXf>;

  int outputs = 1;
  float l2 = 0.0F;

  template <class Subnet>
  void setup(const Subnet& sub) {
    const dlib::tensor& input = sub.get_output();
    inputs_ = input.k() * input.nr() * input.nc();
    parameters_.set_size(1, outputs * (inputs_ + 1));
    parameters_ = 0.0F;
  }

  template <class Subnet>
  void forward(const Subnet& sub, dlib::resizable_tensor& output) {
    const dlib::tensor& input = sub.get_output();
    output.set_size(input.num_samples(), outputs);
    Weights y(output.host_write_only(), outputs, output.num_samples());
    y.noalias() = weights() * ConstWeights(input.host(), inputs_, input.num_samples());
    y.colwise() += bias();
  }

  template <class Subnet>
  void backward(const dlib::tensor& gradient, Subnet& sub, dlib::tensor& of_parameters) {
    const dlib::tensor& input = sub.get_output();
    const ConstWeights dy(gradient.host(), outputs, gradient.num_samples());
    const ConstWeights x(input.host(), inputs_, input.num_samples());
    float* const numbers = of_parameters.host_write_only();
    Weights dW(numbers, outputs, inputs_);
    dW.noalias() = dy * x.transpose();
    dW += l2 * weights();
    Eigen::Map<Eigen::VectorXf>(numbers + dW.size(), outputs) = dy.rowwise().sum();
    Weights dx(sub.get_gradient_input().host(), inputs_, gradient.num_samples());
    dx.noalias() += weights().transpose() * dy;
  }

  const dlib::tensor& get_layer_params() const { return parameters_; }
  dlib::tensor& get_layer_params() { return parameters_; }

  ConstWeights weights() const { return {parameters_.host(), outputs, inputs_}; }
  Weights weights() { return {parameters_.host(), outputs, inputs_}; }
  Eigen::Map<const Eigen::VectorXf> bias() const { return {parameters_.host() + outputs * inputs_, outputs}; }

 private:
  long inputs_ = 0;
  dlib::resizable_tensor parameters_;  // the weights, column by column, then the bias
};

template <int layers>
struct Hidden {
  using type = dlib::htan<dlib::add_layer<Dense, typename Hidden<layers - 1>::type>>;
};
template <>
struct Hidden<0> {
  using type = dlib::input<dlib::matrix<float>>;
};
template <int layers>
using Net = dlib::add_loss_layer<QuestionLoss, dlib::add_layer<Dense, typename Hidden<layers>::type>>;

/// The layers with weights, from the first to the last.
template <class AnyNet>
std::vector<Dense*> dense_layers(AnyNet& net) {
  std::vector<Dense*> layers;
  dlib::visit_computational_layers(net, [&layers](auto& layer) {
    if constexpr (std::is_same_v<std::decay_t<decltype(layer)>, Dense>) layers.push_back(&layer);
  });
  std::reverse(layers.begin(), layers.end());
  return layers;
}

// ---------------------------------------------------------------- one training

struct Standardisation {
  Eigen::VectorXf mean, scale;
};

Standardisation standardisation_of(const Eigen::MatrixXf& inputs, double least_scale) {
  const Eigen::VectorXd mean = inputs.cast<double>().rowwise().mean();
  const Eigen::VectorXd variance =
      (inputs.cast<double>().colwise() - mean).rowwise().squaredNorm() / static_cast<double>(inputs.cols());
  // An input that never changes says nothing; it is not blown up.
  const Eigen::VectorXd scale =
      (variance.array() > 1e-12).select(variance.array().sqrt(), 1.0).max(least_scale);
  return {mean.cast<float>(), scale.cast<float>()};
}

std::vector<std::size_t> shuffled(std::size_t count, RandomGenerator& random) {
  std::vector<std::size_t> order(count);
  std::iota(order.begin(), order.end(), std::size_t{0});
  for (std::size_t i = count; i > 1; --i) std::swap(order[i - 1], order[random() % i]);
  return order;
}

template <int layers>
class Training {
 public:
  Training(const TrainingSet& set, int outputs, const TrainingSettings& settings)
      : set_(set),
        settings_(settings),
        random_(derive_seed(settings.seed, "training")),
        standardisation_(standardisation_of(set.inputs, settings.least_scale)),
        solvers_(Net<layers>::num_computational_layers, dlib::adam(0.0F, 0.9F, 0.999F)) {
    net_.loss_details().rows = set.rows;
    const std::vector<Dense*> dense = dense_layers(net_);
    for (std::size_t i = 0; i < dense.size(); ++i) {
      dense[i]->outputs = i < settings.hidden.size() ? settings.hidden[i] : outputs;
      dense[i]->l2 = static_cast<float>(settings.l2);
    }
    const std::vector<dlib::matrix<float>> example(1, dlib::zeros_matrix<float>(set.inputs.rows(), 1));
    net_.to_tensor(example.begin(), example.end(), batch_);
    net_.subnet().forward(batch_);  // which gives the layers their sizes
    for (Dense* layer : dense) draw_weights(*layer);
  }

  NetworkParameters run(const TrainingProgress& progress) {
    const std::size_t size = static_cast<std::size_t>(settings_.batch);
    const std::size_t batches = (set_.questions() + size - 1) / size;
    for (int epoch = 0; epoch < settings_.epochs; ++epoch) {
      const std::vector<std::size_t> order = shuffled(set_.questions(), random_);
      for (std::size_t i = 0; i < batches; ++i) {
        const double share =
            (epoch + static_cast<double>(i) / static_cast<double>(batches)) / settings_.epochs;
        if (progress && i % 16 == 0 && !progress(share)) throw SetupError("the training was stopped");
        load(order, i * size, std::min(set_.questions(), (i + 1) * size));
        net_.compute_parameter_gradients(batch_, answers_.begin());
        const double rate = settings_.learning_rate * 0.5 * (1.0 + std::cos(std::numbers::pi * share));
        net_.update_parameters(dlib::make_sstack(solvers_), rate);
      }
    }
    return parameters();
  }

 private:
  /// Uniform with the variance 2 / (inputs + outputs): Glorot and Bengio, AISTATS 2010.
  void draw_weights(Dense& layer) {
    Dense::Weights weights = layer.weights();
    const double bound = std::sqrt(6.0 / static_cast<double>(weights.rows() + weights.cols()));
    for (float& weight : weights.reshaped()) weight = static_cast<float>(random_.uniform(-bound, bound));
  }

  void load(const std::vector<std::size_t>& order, std::size_t first, std::size_t end) {
    const Eigen::Index features = set_.inputs.rows();
    const auto rows = static_cast<Eigen::Index>(set_.rows);
    batch_.set_size(static_cast<long>(end - first) * rows, features, 1, 1);
    answers_.clear();
    float* value = batch_.host_write_only();
    for (std::size_t i = first; i < end; ++i, value += features * rows) {
      const std::size_t question = order[i];
      Eigen::Map<Eigen::MatrixXf> into(value, features, rows);
      into = set_.inputs.middleCols(static_cast<Eigen::Index>(question) * rows, rows);
      into.colwise() -= standardisation_.mean;
      into.array().colwise() /= standardisation_.scale.array();
      answers_.push_back({set_.answers[question], set_.weights[question]});
    }
  }

  NetworkParameters parameters() {
    NetworkParameters result;
    result.mean = standardisation_.mean.cast<double>();
    result.scale = standardisation_.scale.cast<double>();
    for (Dense* layer : dense_layers(net_)) {
      NetworkLayer& into = result.layers.emplace_back();
      into.weights = std::as_const(*layer).weights().cast<double>();
      into.bias = std::as_const(*layer).bias().cast<double>();
      into.activation = Activation::tanh;
    }
    result.layers.back().activation = Activation::none;
    result.result = set_.rows > 1 ? NetworkResult::softmax_of_rows : NetworkResult::softmax_of_outputs;
    return result;
  }

  const TrainingSet& set_;
  const TrainingSettings& settings_;
  RandomGenerator random_;
  Standardisation standardisation_;
  Net<layers> net_;
  std::vector<dlib::adam> solvers_;
  dlib::resizable_tensor batch_;
  std::vector<Answer> answers_;
};

template <int layers>
NetworkParameters train(const TrainingSet& set, int outputs, const TrainingSettings& settings,
                        const TrainingProgress& progress) {
  return Training<layers>(set, outputs, settings).run(progress);
}

constexpr std::array trainings = {train<1>, train<2>, train<3>, train<4>, train<5>};

void check(const TrainingSet& set, int outputs) {
  Findings found;
  const std::size_t questions = set.questions();
  found.require(questions > 0, "there is nothing to learn from");
  found.require(
      set.rows >= 1 &&
          static_cast<std::size_t>(set.inputs.cols()) == questions * static_cast<std::size_t>(set.rows) &&
          set.weights.size() == questions,
      "the questions, their answers and their weights are not equally many");
  found.require(set.inputs.allFinite(), "there are features that are not finite");
  const int classes = set.rows > 1 ? set.rows : outputs;
  found.require(std::all_of(set.answers.begin(), set.answers.end(),
                            [classes](int answer) { return answer >= 0 && answer < classes; }),
                "there are answers that are none of the classes");
  throw_if_any(found.take());
}

}  // namespace

std::vector<std::string> problems_with(const TrainingSettings& settings) {
  Findings found("training ");
  found.require(!settings.hidden.empty() && settings.hidden.size() <= trainings.size(),
                "has " + std::to_string(settings.hidden.size()) + " hidden layers; it must be 1 to " +
                    std::to_string(trainings.size()));
  for (const int width : settings.hidden) {
    found.require(width >= 1 && width <= NeuralNetwork::max_width,
                  "has a layer of " + std::to_string(width) + "; it must be 1 to " +
                      std::to_string(NeuralNetwork::max_width));
  }
  found.not_negative("l2", settings.l2);
  found.not_negative("least_scale", settings.least_scale);
  found.positive("learning_rate", settings.learning_rate);
  found.require(settings.epochs >= 1,
                "has " + std::to_string(settings.epochs) + " epochs; it must be 1 or more");
  found.require(settings.batch >= 1, "has empty batches");
  return found.take();
}

TrainingSet chosen(const TrainingSet& set, const std::vector<std::size_t>& questions) {
  TrainingSet result;
  result.rows = set.rows;
  const auto rows = static_cast<Eigen::Index>(set.rows);
  result.inputs.resize(set.inputs.rows(), static_cast<Eigen::Index>(questions.size()) * rows);
  for (std::size_t i = 0; i < questions.size(); ++i) {
    const std::size_t from = questions[i];
    result.inputs.middleCols(static_cast<Eigen::Index>(i) * rows, rows) =
        set.inputs.middleCols(static_cast<Eigen::Index>(from) * rows, rows);
    result.answers.push_back(set.answers[from]);
    result.weights.push_back(set.weights[from]);
    result.groups.push_back(set.groups[from]);
  }
  return result;
}

NetworkParameters train_network(const TrainingSet& set, int outputs, const TrainingSettings& settings,
                                const TrainingProgress& progress) {
  throw_if_any(problems_with(settings));
  check(set, outputs);
  return trainings[settings.hidden.size() - 1](set, outputs, settings, progress);
}

}  // namespace flinch
