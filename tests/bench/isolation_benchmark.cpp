// What it costs in a tick to say what is touched, where and how hard, of 50 N across a second link at home.
#include <benchmark/benchmark.h>

#include "systems/contact/contact_locator.h"
#include "systems/contact/evidence_estimator.h"
#include "systems/contact/feature_extraction.h"
#include "systems/contact/link_particles.h"
#include "systems/contact/touch_hypotheses.h"
#include "systems/robot/planar_rrr.h"
#include "systems/robot/planar_rrr_presets.h"

namespace flinch {
namespace {

struct Touch {
  std::shared_ptr<const PlanarRrr> robot =
      std::make_shared<PlanarRrr>(bench_robot(BenchGeometry::individual, BenchFriction::test_bench));
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

void ContactFeaturesOfAWrench(benchmark::State& state) {
  Touch touch;
  for (auto _ : state) {
    benchmark::DoNotOptimize(touch.estimate);
    benchmark::DoNotOptimize(contact_features(*touch.robot, touch.k, touch.estimate, {}));
  }
}
BENCHMARK(ContactFeaturesOfAWrench);

void ContactEvidenceOfAWrench(benchmark::State& state) {
  Touch touch;
  const TouchHypotheses hypotheses(touch.robot, {});
  ContactEvidence evidence;
  for (auto _ : state) {
    benchmark::DoNotOptimize(touch.wrench);
    hypotheses.weigh(touch.k, touch.wrench, touch.covariance, evidence);
    benchmark::DoNotOptimize(evidence);
  }
}
BENCHMARK(ContactEvidenceOfAWrench);

void ClosedFormOnALink(benchmark::State& state) {
  Touch touch;
  for (auto _ : state) {
    benchmark::DoNotOptimize(touch.wrench);
    const LinkContactMap link = link_contact_map(*touch.robot, touch.k, touch.body);
    benchmark::DoNotOptimize(locate_on_link(link, touch.body, touch.wrench, touch.covariance, {}));
  }
}
BENCHMARK(ClosedFormOnALink);

void LinkParticlesStep(benchmark::State& state) {
  Touch touch;
  const LinkParticleSettings settings{.particles = static_cast<int>(state.range(0))};
  LinkParticles particles(1);
  particles.begin(touch.link, touch.k, {}, touch.estimate.drive_torque, settings);
  for (auto _ : state) {
    benchmark::DoNotOptimize(touch.estimate);
    benchmark::DoNotOptimize(particles.step(touch.link, touch.k, touch.estimate.drive_torque, settings));
  }
}
BENCHMARK(LinkParticlesStep)->Arg(50)->Arg(200);

}  // namespace
}  // namespace flinch
