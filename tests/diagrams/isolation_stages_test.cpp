#include "diagrams/isolation_stages.h"

#include <gmock/gmock.h>

#include <cmath>
#include <memory>

#include "systems/foundation/setup_error.h"
#include "tests/diagrams/contact_rig.h"
#include "tests/support/allocations.h"

namespace flinch {
namespace {

using test::Bench;
using test::RigExperiment;
using testing::ElementsAre;

/// A rig with every classifier and locator that flinch has.
RigExperiment all_stages() {
  RigExperiment experiment;
  experiment.control.stages.classifiers.all = classifier_stages();
  experiment.control.stages.locators.all = locator_stages();
  experiment.control.sequence.zero_g_when_struck = false;
  return experiment;
}

ContactClassification said(const Bench& rig) { return rig.context.get(rig.control.classification); }

TEST(IsolationStages, ClassifyAndLocateAPushOnThePlatform) {
  Bench rig(all_stages());
  rig.run(500ms);
  EXPECT_FALSE(said(rig).valid);
  rig.push(PlatformVector{{-45.0, 0.0, 2.0}});
  rig.run(60ms);
  ASSERT_TRUE(rig.context.get(rig.control.contact).active);
  const ContactClassification classified = said(rig);
  ASSERT_TRUE(classified.valid);
  EXPECT_EQ(classified.most_likely, 0);
  const ContactLocation location = rig.context.get(rig.control.location);
  ASSERT_TRUE(location.valid && location.located);
  EXPECT_NEAR((location.point_in_base - CartesianVector(rig.pose().head<2>())).norm(), 0.137, 1e-9);
  EXPECT_NEAR(location.force_in_base[0], -45.0, 5.0);
  const ContactLocation by_particles = rig.context.get(rig.control.others.locations[0].port);
  ASSERT_TRUE(by_particles.valid && by_particles.located);
  EXPECT_EQ(by_particles.point_in_base, location.point_in_base);
  EXPECT_EQ(by_particles.residual, location.residual);
}

TEST(IsolationStages, RunSideBySideAndNeverAllocate) {
  Bench rig(all_stages());
  ASSERT_EQ(rig.control.others.classifications.size(), 1U);
  EXPECT_EQ(rig.control.others.classifications[0].name, "classification_decision_tree");
  ASSERT_EQ(rig.control.others.locations.size(), 1U);
  EXPECT_EQ(rig.control.others.locations[0].name, "location_particle_filter");
  ASSERT_EQ(rig.control.others.clouds.size(), 1U);
  EXPECT_EQ(rig.control.others.clouds[0].name, "particles_particle_filter");
  rig.run(500ms);
  // As of 50 N across the second link of leg 1.
  const LinkContactMap link = [&] {
    Kinematics k;
    rig.robot->kinematics(rig.pose(), PlatformVector::Zero(3), k);
    return link_contact_map(*rig.robot, k, BodyId::link2(0));
  }();
  rig.push((link.at_joint + 0.7 * link.along) * CartesianVector(Eigen::Vector2d(0.0, 50.0)));
  rig.tick();  // a first contact
  const test::AllocationCounter allocations;
  rig.run(60ms);
  EXPECT_EQ(allocations.count(), 0);
  const auto& tree = rig.context.get(rig.control.others.classifications[0].port);
  ASSERT_TRUE(tree.valid);
  EXPECT_EQ(ContactClasses(7, 3).leg(tree.most_likely), 0);
}

/// A network that says the same of everything: scores for its answers.
std::shared_ptr<const NeuralNetwork> always(int inputs, const Eigen::VectorXd& scores) {
  NetworkParameters parameters;
  parameters.layers.push_back({Eigen::MatrixXd::Zero(scores.size(), inputs), scores, Activation::none});
  parameters.result = NetworkResult::softmax_of_outputs;
  return std::make_shared<NeuralNetwork>(parameters);
}

TEST(IsolationStages, FollowTheThreeNetworksOfThePapers) {
  RigExperiment experiment = all_stages();
  experiment.control.stages.classifiers.follow(papers_networks_stage(
      {.clamping = always(6, Eigen::Vector2d(std::log(19.0), 0.0)),
       .chain = always(6, Eigen::Vector3d::Zero()),
       .body = always(12, std::log(114.0) * Eigen::VectorXd::Unit(7, 4))}));  // 0.95 of the fifth
  Bench rig(experiment);
  rig.run(500ms);
  EXPECT_FALSE(said(rig).valid);
  rig.push(PlatformVector{{-45.0, 0.0, 2.0}});
  rig.tick();
  const test::AllocationCounter allocations;
  rig.run(60ms);
  EXPECT_EQ(allocations.count(), 0);
  const ContactClassification classified = said(rig);
  ASSERT_TRUE(classified.valid && classified.accepted);
  EXPECT_EQ(classified.most_likely, 4);
  EXPECT_NEAR(classified.confidence(), 0.95 * 0.95, 1e-9);
  EXPECT_NEAR(classified.probability[8], 0.05 / 3.0, 1e-9);
  EXPECT_EQ(rig.context.get(rig.control.location).body, 4);
}

TEST(IsolationStages, AreKnownByTheirNames) {
  const ControlStages known = known_stages();
  EXPECT_THAT(names_of(known.classifiers),
              ElementsAre("model_classifier", "decision_tree", "papers_networks", "learned_classifier"));
  EXPECT_THAT(names_of(known.locators), ElementsAre("closed_form", "particle_filter"));
}

TEST(IsolationStages, RefuseToAskNetworksThatNobodyHasAdded) {
  RigExperiment experiment;
  experiment.control.stages.classifiers.follow(known_stages().classifiers.all[2]);
  try {
    Bench rig(experiment);
    FAIL();
  } catch (const SetupError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("'papers_networks' asks networks"));
  }
}

TEST(IsolationStages, KnowAClassifierThatAProgramAddsByItsName) {
  const auto refuse = [](const StageContext&, const ContactPorts&) -> OutputPort<ContactClassification> {
    throw SetupError("never built");
  };
  add_known_classifier({"own_classifier", refuse, true});
  add_known_classifier({"own_classifier", refuse, true});  // again: it is there once
  const ControlStages known = known_stages();
  EXPECT_THAT(names_of(known.classifiers), ElementsAre("model_classifier", "decision_tree", "papers_networks",
                                                       "learned_classifier", "own_classifier"));
}

TEST(IsolationStages, NeedAnObserverWithAPositiveGain) {
  RigExperiment experiment;
  experiment.control.isolation.observer_gain = 0.0;
  EXPECT_THROW(Bench{experiment}, SetupError);
}

}  // namespace
}  // namespace flinch
