#include "learning/train_network.h"

#include <gmock/gmock.h>

#include <thread>

#include "systems/foundation/setup_error.h"
#include "systems/framework/random.h"
#include "tests/support/problems_of.h"

namespace flinch {
namespace {

void add(TrainingSet& set, int answer) {
  set.answers.push_back(answer);
  set.weights.push_back(1.0F);
  set.groups.push_back(static_cast<int>(set.answers.size()));
}

/// Points of a square; the right class says whether the signs of both coordinates agree, which no straight
/// line divides. The first coordinate is far from 0 and large.
TrainingSet two_classes(int count, std::uint64_t seed) {
  RandomGenerator random(seed);
  TrainingSet set;
  set.inputs.resize(2, count);
  for (int i = 0; i < count; ++i) {
    const double x = random.uniform(-1.0, 1.0), y = random.uniform(-1.0, 1.0);
    set.inputs.col(i) << static_cast<float>(500.0 + 100.0 * x), static_cast<float>(y);
    add(set, x * y > 0.0 ? 1 : 0);
  }
  return set;
}

/// Four points on a line; the answer is the one nearest to 0.3.
TrainingSet which_is_nearest(int count, std::uint64_t seed) {
  RandomGenerator random(seed);
  TrainingSet set;
  set.rows = 4;
  set.inputs.resize(1, 4 * count);
  for (int i = 0; i < count; ++i) {
    int nearest = 0;
    for (int row = 0; row < 4; ++row) {
      set.inputs(0, 4 * i + row) = static_cast<float>(random.uniform(-1.0, 1.0));
      if (std::abs(set.inputs(0, 4 * i + row) - 0.3F) < std::abs(set.inputs(0, 4 * i + nearest) - 0.3F))
        nearest = row;
    }
    add(set, nearest);
  }
  return set;
}

double accuracy(const NetworkParameters& parameters, const TrainingSet& set) {
  const NeuralNetwork network(parameters);
  int right = 0;
  NeuralNetwork::Values outputs;
  for (std::size_t i = 0; i < set.questions(); ++i) {
    const auto first = static_cast<Eigen::Index>(i) * set.rows;
    EXPECT_TRUE(network.evaluate(set.inputs.middleCols(first, set.rows).cast<double>(), outputs));
    Eigen::Index best = 0;
    outputs.reshaped().maxCoeff(&best);
    right += best == set.answers[i] ? 1 : 0;
  }
  return static_cast<double>(right) / static_cast<double>(set.questions());
}

const TrainingSettings quick{
    .hidden = {12, 8}, .l2 = 1e-6, .learning_rate = 1e-2, .epochs = 60, .batch = 64, .seed = 1};

TEST(TrainNetwork, FindsClassesThatNoLineDivides) {
  const NetworkParameters network = train_network(two_classes(2000, 1), 2, quick);
  EXPECT_EQ(network.result, NetworkResult::softmax_of_outputs);
  EXPECT_GT(accuracy(network, two_classes(2000, 2)), 0.97);
}

TEST(TrainNetwork, FindsWhichRowAnswersAQuestion) {
  const NetworkParameters network = train_network(which_is_nearest(8000, 1), 1, quick);
  EXPECT_EQ(network.result, NetworkResult::softmax_of_rows);
  EXPECT_GT(accuracy(network, which_is_nearest(2000, 2)), 0.97);
}

TEST(TrainNetwork, FindsTheSameBitsAgainWhateverOtherThreadsDo) {
  const TrainingSet set = two_classes(300, 1);
  TrainingSettings settings = quick;
  settings.epochs = 3;
  std::vector<NetworkParameters> found(3);
  {
    std::vector<std::jthread> threads;
    for (NetworkParameters& each : found)
      threads.emplace_back([&] { each = train_network(set, 2, settings); });
  }
  for (const NetworkParameters& each : found) {
    for (std::size_t i = 0; i < each.layers.size(); ++i)
      EXPECT_EQ(each.layers[i].weights, found.front().layers[i].weights);
  }
  settings.seed = 2;
  EXPECT_NE(train_network(set, 2, settings).layers[0].weights, found.front().layers[0].weights);
}

TEST(TrainNetwork, KeepsWeightsSmallWhereItIsToldTo) {
  const TrainingSet set = two_classes(500, 1);
  const auto size = [&](double l2) {
    TrainingSettings settings = quick;
    settings.l2 = l2;
    return train_network(set, 2, settings).layers[0].weights.norm();
  };
  EXPECT_LT(size(0.1), 0.5 * size(0.0));
}

// As where all is learned in one pose: a number that hardly varied there is another one elsewhere.
TEST(TrainNetwork, IsNotThrownOffByWhatHardlyVariedWhereTheLeastScaleIsLarge) {
  const auto in_place = [](TrainingSet set, std::uint64_t seed, float place) {
    RandomGenerator random(seed);
    set.inputs.conservativeResize(3, Eigen::NoChange);
    for (Eigen::Index i = 0; i < set.inputs.cols(); ++i) {
      set.inputs(0, i) = 0.01F * (set.inputs(0, i) - 500.0F);
      set.inputs(2, i) = place + static_cast<float>(1e-4 * random.normal());
    }
    return set;
  };
  const TrainingSet here = in_place(two_classes(2000, 1), 1, 0.1F);
  const TrainingSet elsewhere = in_place(two_classes(2000, 2), 2, 0.2F);
  TrainingSettings settings = quick;
  settings.l2 = 1e-4;
  EXPECT_LT(accuracy(train_network(here, 2, settings), elsewhere), 0.9);
  settings.least_scale = 1.0;
  EXPECT_GT(accuracy(train_network(here, 2, settings), elsewhere), 0.97);
}

TEST(TrainNetwork, ServesOneToFiveHiddenLayers) {
  const TrainingSet set = two_classes(200, 1);
  for (std::size_t layers = 1; layers <= 5; ++layers) {
    TrainingSettings settings = quick;
    settings.hidden.assign(layers, 6);
    settings.epochs = 1;
    EXPECT_EQ(train_network(set, 2, settings).layers.size(), layers + 1);
  }
}

TEST(TrainNetwork, SaysWhatItCannotTrainWith) {
  TrainingSettings settings = quick;
  settings.hidden = {};
  settings.l2 = -1.0;
  settings.least_scale = -2.0;
  EXPECT_THAT(problems_with(settings),
              testing::ElementsAre("training has 0 hidden layers; it must be 1 to 5",
                                   "training l2 is -1; it must not be negative",
                                   "training least_scale is -2; it must not be negative"));
  TrainingSet set = two_classes(10, 1);
  set.answers[3] = 2;
  EXPECT_THAT(test::problems_of([&] { train_network(set, 2, quick); }),
              testing::ElementsAre("there are answers that are none of the classes"));
  EXPECT_THAT(test::problems_of([&] { train_network(TrainingSet(), 2, quick); }),
              testing::ElementsAre("there is nothing to learn from"));
}

}  // namespace
}  // namespace flinch
