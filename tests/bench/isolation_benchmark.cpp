// What it costs in a tick to say what is touched, where and how hard, of 50 N across a second link at home.
// The counter `times_the_model` is the ratio to one evaluation of kinematics and dynamics, measured in the
// same run.
#include <benchmark/benchmark.h>

#include <algorithm>

#include "systems/contact/contact_locator.h"
#include "systems/contact/evidence_features.h"
#include "systems/contact/feature_extraction.h"
#include "systems/contact/link_particles.h"
#include "systems/contact/neural_network.h"
#include "systems/contact/papers_classifier.h"
#include "systems/contact/touch_hypotheses.h"
#include "systems/contact/wrench_uncertainty.h"
#include "systems/framework/random.h"
#include "systems/robot/hexapod.h"
#include "systems/robot/hexapod_presets.h"
#include "systems/robot/planar_rrr.h"
#include "systems/robot/planar_rrr_presets.h"
#include "tests/support/processor_time.h"

namespace flinch {
namespace {

struct Touch {
  std::shared_ptr<const PlanarRrr> robot =
      std::make_shared<PlanarRrr>(rig_robot(RigGeometry::individual, RigFriction::test_rig));
  Kinematics k = [this] {
    Kinematics now;
    robot->kinematics(robot->home_pose(), PlatformVector{{0.5, 0.2, 0.3}}, now);
    return now;
  }();
  BodyId body = BodyId::link2(0);
  LinkContactMap link = link_contact_map(*robot, k, body);
  PlatformVector wrench = (link.at_joint + 0.7 * link.along) * CartesianVector(Eigen::Vector2d(0.0, 50.0));
  PlatformMatrix covariance = WrenchUncertainty().covariance(robot->space(), wrench);
  WrenchEstimate estimate{
      .acquired = {}, .valid = true, .wrench_in_base = wrench, .drive_torque = drive_torques(k, wrench)};
};

/// Seconds that `work` takes: the least of some turns of many.
double time_of(int turns, auto&& work) {
  double best = 1.0;
  for (int turn = 0; turn < 20; ++turn) {
    const auto begin = test::processor_time();
    for (int i = 0; i < turns; ++i) work();
    best = std::min(best, (test::processor_time() - begin).count() / turns);
  }
  return best;
}

/// Runs `work` as a benchmark and sets it beside one evaluation of the model.
void compare(benchmark::State& state, const Touch& touch, auto&& work) {
  for (auto _ : state) work();
  Kinematics now;
  Dynamics model;
  const double evaluation = time_of(2000, [&] {
    touch.robot->kinematics(touch.robot->home_pose(), touch.k.velocity, now);
    touch.robot->dynamics(now, model);
    benchmark::DoNotOptimize(model.valid);
  });
  state.counters["times_the_model"] = time_of(100, work) / evaluation;
}

NeuralNetwork network(int inputs, const std::vector<int>& widths, NetworkResult result) {
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

/// [SafePR] III: the features, then clamping or not, which leg, which body.
void PapersFeaturesAndNetworks(benchmark::State& state) {
  const Touch touch;
  const auto papers = [](int inputs, const std::vector<int>& widths) {
    return std::make_shared<NeuralNetwork>(network(inputs, widths, NetworkResult::softmax_of_outputs));
  };
  const PapersClassifier classifier(touch.robot, {.clamping = papers(6, {30, 30, 30, 30, 30, 2}),
                                                  .chain = papers(6, {25, 25, 25, 25, 25, 3}),
                                                  .body = papers(12, {30, 30, 30, 30, 7})});
  ClassVector probability;
  compare(state, touch, [&] {
    const ContactFeatures features =
        contact_features(*touch.robot, touch.k, touch.estimate, FeatureSettings());
    benchmark::DoNotOptimize(classifier.ask(features, probability));
  });
}
BENCHMARK(PapersFeaturesAndNetworks);

void EvidenceOfTheModel(benchmark::State& state) {
  const Touch touch;
  const TouchHypotheses hypotheses(touch.robot, {});
  ContactEvidence evidence;
  compare(state, touch, [&] {
    hypotheses.weigh(touch.k, touch.wrench, touch.covariance, evidence);
    benchmark::DoNotOptimize(evidence.valid);
  });
}
BENCHMARK(EvidenceOfTheModel);

/// The same of a push of 50 N on the platform of a 6-UPS that moves.
void EvidenceOfTheModelInSpace(benchmark::State& state) {
  const Hexapod robot(hexapod_robot());
  const TouchHypotheses hypotheses(std::make_shared<Hexapod>(hexapod_robot()), {});
  Kinematics k;
  robot.kinematics(robot.home_pose(), PlatformVector{{0.4, 0.1, -0.1, 0.3, 0.2, 0.1}}, k);
  const PlatformVector wrench{{-48.0, -12.0, 5.0, 0.4, -1.8, 3.0}};
  const PlatformMatrix covariance = WrenchUncertainty().covariance(robot.space(), wrench);
  ContactEvidence evidence;
  const auto weigh = [&] {
    hypotheses.weigh(k, wrench, covariance, evidence);
    benchmark::DoNotOptimize(evidence.valid);
  };
  for (auto _ : state) weigh();
  Kinematics now;
  Dynamics model;
  const double evaluation = time_of(500, [&] {
    robot.kinematics(robot.home_pose(), k.velocity, now);
    robot.dynamics(now, model);
    benchmark::DoNotOptimize(model.valid);
  });
  state.counters["times_the_model"] = time_of(30, weigh) / evaluation;
}
BENCHMARK(EvidenceOfTheModelInSpace);

/// Evidence of the wrench and of its growth, the course of the legs, features, and the scorer of all classes.
void LearnedClassifierOfAWrench(benchmark::State& state) {
  const Touch touch;
  const TouchHypotheses hypotheses(touch.robot, {});
  const NeuralNetwork scorer = network(evidence_feature_count, {80, 48, 1}, NetworkResult::softmax_of_rows);
  const PlatformVector grown = 0.9 * touch.wrench;
  const PlatformMatrix of_grown = WrenchUncertainty().covariance(touch.robot->space(), grown);
  ContactMoments moments;
  moments.fill({0.5 * touch.wrench, touch.k.velocity});
  ContactEvidence whole, growth;
  NeuralNetwork::Values features, outputs;
  compare(state, touch, [&] {
    hypotheses.weigh(touch.k, touch.wrench, touch.covariance, whole);
    hypotheses.weigh(touch.k, grown, of_grown, growth);
    const LegCourses courses = leg_histories(*touch.robot, touch.k, moments).value();
    evidence_features(hypotheses.classes(), {whole, growth, courses, 50.0}, features);
    benchmark::DoNotOptimize(scorer.evaluate(features, outputs));
  });
}
BENCHMARK(LearnedClassifierOfAWrench);

void ClosedFormOnALink(benchmark::State& state) {
  const Touch touch;
  compare(state, touch, [&] {
    const LinkContactMap link = link_contact_map(*touch.robot, touch.k, touch.body);
    benchmark::DoNotOptimize(locate_on_link(link, touch.body, touch.k.velocity, touch.wrench,
                                            touch.covariance, touch.covariance, {}));
  });
}
BENCHMARK(ClosedFormOnALink);

/// Of so many particles; of pushes that are orthogonal, or may lean.
void ParticleFilterStep(benchmark::State& state, double leaning) {
  const Touch touch;
  const LinkParticleSettings settings{.particles = static_cast<int>(state.range(0)), .leaning = leaning};
  LinkParticles particles(1);
  particles.begin(touch.link, touch.k, {}, touch.estimate.drive_torque, settings);
  compare(state, touch, [&] {
    benchmark::DoNotOptimize(particles.step(touch.link, touch.k, touch.estimate.drive_torque, settings));
  });
}
BENCHMARK_CAPTURE(ParticleFilterStep, orthogonal, 0.0)->Arg(50)->Arg(200);
BENCHMARK_CAPTURE(ParticleFilterStep, leaning, 0.15)->Arg(50)->Arg(200);

}  // namespace
}  // namespace flinch
