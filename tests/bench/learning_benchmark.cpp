// What it costs in a tick to tell what was touched: the papers' features and three networks; the evidence of
// the model, and the scorer of all classes. observer_benchmark.cpp has the blocks to compare them with.
#include <benchmark/benchmark.h>

#include "systems/contact/evidence_features.h"
#include "systems/contact/feature_extraction.h"
#include "systems/contact/neural_network.h"
#include "systems/contact/touch_hypotheses.h"
#include "systems/contact/wrench_uncertainty.h"
#include "systems/framework/random.h"
#include "systems/robot/planar_rrr.h"
#include "systems/robot/planar_rrr_presets.h"

namespace flinch {
namespace {

std::shared_ptr<const PlanarRrr> bench() {
  static const auto robot =
      std::make_shared<PlanarRrr>(bench_robot(BenchGeometry::individual, BenchFriction::test_bench));
  return robot;
}

NeuralNetwork network(int inputs, std::vector<int> widths, NetworkResult result) {
  RandomGenerator random(1);
  NetworkParameters parameters;
  parameters.mean = Eigen::VectorXd::Zero(inputs);
  parameters.scale = Eigen::VectorXd::Ones(inputs);
  for (const int width : widths) {
    NetworkLayer& layer = parameters.layers.emplace_back();
    layer.weights.resize(width, inputs);
    for (double& weight : layer.weights.reshaped()) weight = 0.3 * random.normal();
    layer.bias.setZero(width);
    layer.activation = Activation::tanh;
    inputs = width;
  }
  parameters.layers.back().activation = Activation::none;
  parameters.result = result;
  return NeuralNetwork(parameters);
}

struct Touched {
  Touched() {
    bench()->kinematics(bench()->home_pose(), PlatformVector::Constant(3, 0.1), kinematics);
    estimate.valid = true;
    estimate.wrench_in_base = Eigen::Vector3d(30.0, -20.0, 1.0);
    estimate.drive_torque = drive_torques(kinematics, estimate.wrench_in_base);
  }
  Kinematics kinematics;
  WrenchEstimate estimate;
};

/// [SafePR] III: the features, then clamping or not, which leg, which body.
void papers_features_and_networks(benchmark::State& state) {
  const Touched touched;
  const NeuralNetwork body = network(12, {30, 30, 30, 30, 7}, NetworkResult::softmax_of_outputs);
  const NeuralNetwork clamping = network(6, {30, 30, 30, 30, 30, 2}, NetworkResult::softmax_of_outputs);
  const NeuralNetwork chain = network(6, {25, 25, 25, 25, 25, 3}, NetworkResult::softmax_of_outputs);
  NeuralNetwork::Values inputs, few, outputs;
  for (auto _ : state) {
    inputs =
        feature_vector(contact_features(*bench(), touched.kinematics, touched.estimate, FeatureSettings()));
    few.resize(6, 1);
    few << inputs.topRows(3), inputs.middleRows(6, 3);
    benchmark::DoNotOptimize(clamping.evaluate(few, outputs));
    benchmark::DoNotOptimize(chain.evaluate(few, outputs));
    benchmark::DoNotOptimize(body.evaluate(inputs, outputs));
  }
}
BENCHMARK(papers_features_and_networks);

void evidence_of_the_model(benchmark::State& state) {
  const Touched touched;
  const TouchHypotheses hypotheses(bench(), TouchHypothesesSettings());
  const PlatformMatrix covariance =
      WrenchUncertainty().covariance(bench()->space(), touched.estimate.wrench_in_base);
  ContactEvidence evidence;
  for (auto _ : state) {
    hypotheses.weigh(touched.kinematics, touched.estimate.wrench_in_base, covariance, evidence);
    benchmark::DoNotOptimize(evidence.valid);
  }
}
BENCHMARK(evidence_of_the_model);

void scorer_of_all_classes(benchmark::State& state) {
  const Touched touched;
  const ContactClasses classes(bench()->body_count(), bench()->legs());
  ContactEvidence evidence;
  TouchHypotheses(bench(), TouchHypothesesSettings())
      .weigh(touched.kinematics, touched.estimate.wrench_in_base,
             WrenchUncertainty().covariance(bench()->space(), touched.estimate.wrench_in_base), evidence);
  const NeuralNetwork scorer = network(evidence_feature_count, {32, 32, 1}, NetworkResult::softmax_of_rows);
  NeuralNetwork::Values features, outputs;
  for (auto _ : state) {
    evidence_features(classes, {evidence, evidence, evidence, 36.0}, features);
    benchmark::DoNotOptimize(scorer.evaluate(features, outputs));
  }
}
BENCHMARK(scorer_of_all_classes);

}  // namespace
}  // namespace flinch
