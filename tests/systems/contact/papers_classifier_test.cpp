#include "systems/contact/papers_classifier.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "systems/contact/feature_extraction.h"
#include "systems/foundation/setup_error.h"
#include "systems/framework/random.h"
#include "tests/support/allocations.h"
#include "tests/support/problems_of.h"
#include "tests/support/ticking.h"
#include "tests/systems/contact/touched_robot.h"

namespace flinch {
namespace {

/// One layer: scores W x + b, so that its probabilities can be written down.
std::shared_ptr<const NeuralNetwork> scorer(int inputs, int outputs, std::uint64_t seed, double size = 0.05) {
  RandomGenerator random(seed);
  NetworkParameters parameters;
  NetworkLayer& layer = parameters.layers.emplace_back();
  layer.weights.resize(outputs, inputs);
  layer.bias.resize(outputs);
  for (double& weight : layer.weights.reshaped()) weight = size * random.normal();
  for (double& bias : layer.bias) bias = random.normal();
  parameters.result = NetworkResult::softmax_of_outputs;
  return std::make_shared<NeuralNetwork>(parameters);
}

PapersClassifierSettings networks(double accept = 0.9) {
  return {.clamping = scorer(6, 2, 1), .chain = scorer(6, 3, 2), .body = scorer(12, 7, 3), .accept = accept};
}

Eigen::VectorXd probabilities(const NeuralNetwork& network, const Eigen::VectorXd& inputs) {
  const NetworkLayer& layer = network.parameters().layers.front();
  const Eigen::VectorXd scores = (layer.weights * inputs + layer.bias).array().exp();
  return scores / scores.sum();
}

struct Classifier {
  explicit Classifier(const PapersClassifierSettings& settings = networks())
      : block(builder.add<PapersClassifier>("classifier", robot, settings)),
        phase(builder.export_input("phase", block.phase)),
        features(builder.export_input("features", block.features)),
        ticking(builder) {}

  ContactFeatures of(const PlatformVector& wrench) const {
    return contact_features(*robot, home, test::estimate_of(home, wrench), {});
  }
  ContactClassification see(const ContactFeatures& seen, bool active = true) {
    ticking.set(features, seen);
    if (active && !active_) since_ = ticking.now();
    active_ = active;
    ticking.set(phase, ContactPhase{active, since_});
    ticking.tick();
    return ticking.get(block.classification);
  }

  std::shared_ptr<const PlanarRrr> robot = test::touched_rig();
  Kinematics home = test::at_home(*robot);
  DiagramBuilder builder;
  PapersClassifier& block;
  InputPort<ContactPhase> phase;
  InputPort<ContactFeatures> features;
  test::Ticking ticking;

 private:
  bool active_ = false;
  Time since_{};
};

const PlatformVector push{{-20.0, 30.0, 2.0}}, other_push{{35.0, 5.0, -3.0}};

TEST(PapersClassifier, MultipliesWhatItsNetworksSay) {
  Classifier classifier;
  const PapersClassifierSettings asked = networks();
  for (const PlatformVector& wrench : {push, other_push}) {
    const ContactFeatures seen = classifier.of(wrench);
    Eigen::VectorXd all(12), few(6);
    all << seen.wrench_in_base, seen.drive_torque, seen.distance, seen.angle;
    few << seen.wrench_in_base, seen.distance;
    const Eigen::VectorXd clamps = probabilities(*asked.clamping, few);
    const Eigen::VectorXd leg = probabilities(*asked.chain, few), body = probabilities(*asked.body, all);
    classifier.see(seen, false);
    const ContactClassification said = classifier.see(seen);
    ASSERT_TRUE(said.valid);
    ASSERT_EQ(said.probability.size(), 10);
    for (int i = 0; i < 7; ++i) EXPECT_NEAR(said.probability[i], clamps[0] * body[i], 1e-12);
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(said.probability[7 + i], clamps[1] * leg[i], 1e-12);
    EXPECT_NEAR(said.probability.sum(), 1.0, 1e-12);
    EXPECT_EQ(said.confidence(), said.probability.maxCoeff());
    EXPECT_EQ(said.acquired, seen.acquired);
  }
}

TEST(PapersClassifier, AcceptsWhatIsSureEnough) {
  Classifier any;
  const double confidence = any.see(any.of(push)).confidence();
  for (const double accept : {0.999 * confidence, 1.001 * confidence}) {
    Classifier classifier(networks(accept));
    EXPECT_EQ(classifier.see(classifier.of(push)).accepted, confidence >= accept);
  }
}

TEST(PapersClassifier, StandsByItsFirstAnswerUntilTheContactEnds) {
  Classifier classifier;
  EXPECT_FALSE(classifier.see(classifier.of(push), false).valid);
  const ContactClassification first = classifier.see(classifier.of(push));
  EXPECT_EQ(classifier.see(classifier.of(other_push)).probability, first.probability);
  EXPECT_EQ(classifier.see(ContactFeatures()).probability, first.probability);
  EXPECT_FALSE(classifier.see(classifier.of(push), false).valid);
  EXPECT_NE(classifier.see(classifier.of(other_push)).probability, first.probability);
}

TEST(PapersClassifier, WaitsForAWrenchAsLargeAsThoseOfWhichItHasLearned) {
  PapersClassifierSettings settings = networks();
  settings.least_wrench = std::hypot(push.head(2).norm() / 2.0, push[2] / 0.2);
  Classifier classifier(settings);
  const ContactClassification small = classifier.see(classifier.of(0.99 * push));
  EXPECT_FALSE(small.valid);
  EXPECT_EQ(small.probability.size(), 0);
  EXPECT_TRUE(classifier.see(classifier.of(1.01 * push)).valid);
  EXPECT_TRUE(classifier.see(classifier.of(0.99 * push)).valid) << "what it has said stands";
}

TEST(PapersClassifier, SaysNothingOfFeaturesThatCannotBeUsed) {
  Classifier classifier;
  ContactFeatures broken = classifier.of(push), short_of_a_leg = classifier.of(push);
  broken.wrench_in_base[1] = std::numeric_limits<double>::quiet_NaN();
  short_of_a_leg.distance.conservativeResize(2);
  for (const ContactFeatures& seen :
       {ContactFeatures(), classifier.of(PlatformVector::Zero(3)), broken, short_of_a_leg}) {
    const ContactClassification said = classifier.see(seen);
    EXPECT_FALSE(said.valid || said.accepted);
    EXPECT_EQ(said.probability.size(), 0);
  }
  EXPECT_TRUE(classifier.see(classifier.of(push)).valid) << "the first that can be used";
}

TEST(PapersClassifier, DoesNotAllocate) {
  Classifier classifier;
  const ContactFeatures seen = classifier.of(push);
  classifier.see(seen, false);
  const test::AllocationCounter allocations;
  EXPECT_TRUE(classifier.see(seen).valid);
  EXPECT_EQ(allocations.count(), 0);
}

TEST(PapersClassifier, NeedsThreeNetworksOfItsRobot) {
  EXPECT_THAT(test::problems_of([] {
                PapersClassifier(test::touched_rig(),
                                 {.clamping = scorer(6, 3, 1), .chain = nullptr, .body = scorer(12, 7, 1)});
              }),
              testing::ElementsAre("papers classifier: the network for the question 'clamping' must make 2 "
                                   "probabilities of 6 inputs",
                                   "papers classifier: there is no network for the question 'chain'"));
}

}  // namespace
}  // namespace flinch
