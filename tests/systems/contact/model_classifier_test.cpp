#include "systems/contact/model_classifier.h"

#include <cmath>

#include "systems/foundation/setup_error.h"
#include "systems/robot/hexapod.h"
#include "systems/robot/hexapod_presets.h"
#include "tests/support/allocations.h"
#include "tests/support/ticking.h"
#include "tests/systems/contact/touched_robot.h"

namespace flinch {
namespace {

struct Classifier {
  explicit Classifier(const ModelClassifierSettings& settings = {},
                      const std::shared_ptr<const ParallelRobot>& robot = test::touched_rig())
      : count(robot->body_count() + robot->legs()),
        block(builder.add<ModelClassifier>("classifier", robot, settings)),
        phase(builder.export_input("phase", block.phase)),
        evidence(builder.export_input("evidence", block.evidence)),
        ticking(builder) {}

  /// Evidence e^`strength` times that of the others for one class, from a force.
  ContactClassification see(int number, double strength, double force, double residual = 1.0,
                            bool active = true) {
    ContactEvidence seen;
    seen.valid = true;
    seen.acquired = ticking.now();
    seen.log_evidence = ClassVector::Constant(count, -50.0);
    seen.log_evidence[number] += strength;
    seen.residual = ClassVector::Constant(count, residual);
    seen.force = ClassVector::Constant(count, force);
    return see(seen, active);
  }
  ContactClassification see(const ContactEvidence& seen, bool active = true) {
    ticking.set(evidence, seen);
    if (active && !active_) since_ = ticking.now();
    active_ = active;
    ticking.set(phase, ContactPhase{active, since_});
    ticking.tick();
    return ticking.get(block.classification);
  }

  int count;
  DiagramBuilder builder;
  ModelClassifier& block;
  InputPort<ContactPhase> phase;
  InputPort<ContactEvidence> evidence;
  test::Ticking ticking;

 private:
  bool active_ = false;
  Time since_{};
};

TEST(ModelClassifier, GivesEveryClassItsShareOfTheEvidence) {
  Classifier classifier;
  const ContactClassification said = classifier.see(4, std::log(81.0), 20.0);
  ASSERT_TRUE(said.valid);
  EXPECT_EQ(said.most_likely, 4);
  EXPECT_NEAR(said.probability[4], 81.0 / 90.0, 1e-12);
  EXPECT_NEAR(said.probability[0], 1.0 / 90.0, 1e-12);
  EXPECT_NEAR(said.probability.sum(), 1.0, 1e-12);
}

TEST(ModelClassifier, AcceptsWhatIsSureEnoughAndRejectsTheRest) {
  EXPECT_TRUE(Classifier().see(4, std::log(81.1), 20.0).accepted);
  EXPECT_FALSE(Classifier().see(4, std::log(80.9), 20.0).accepted);
}

TEST(ModelClassifier, RejectsWhatNoSingleContactExplains) {
  const ContactClassification said = Classifier().see(4, 20.0, 20.0, 16.0);
  EXPECT_TRUE(said.valid && said.several_contacts);
  EXPECT_FALSE(said.accepted);
  EXPECT_EQ(said.residual, 16.0);
  EXPECT_FALSE(Classifier().see(4, 20.0, 20.0, 14.0).several_contacts);
  EXPECT_FALSE(Classifier({.largest_residual = 17.0}).see(4, 20.0, 20.0, 16.0).several_contacts);
  EXPECT_LT(Classifier().see(4, 20.0, 20.0, 14.0, false).residual, 0.0) << "it has not looked";
}

TEST(ModelClassifier, ListensMoreToGreaterForces) {
  Classifier classifier;
  EXPECT_EQ(classifier.see(2, 4.0, 10.0).most_likely, 2);
  const ContactClassification said = classifier.see(5, 4.0, 30.0);
  EXPECT_EQ(said.most_likely, 5);
  // Weights 1 : 9, so that both are 0.4 and 3.6 above the others.
  EXPECT_NEAR(said.probability[5] / said.probability[0], std::exp(3.6), 1e-9);
  EXPECT_NEAR(said.probability[2] / said.probability[0], std::exp(0.4), 1e-9);
}

TEST(ModelClassifier, StandsByWhatItHasFoundInItsWindowUntilTheContactEnds) {
  Classifier classifier({.window = 2ms});
  for (int i = 0; i < 3; ++i) classifier.see(2, 10.0, 20.0);
  EXPECT_EQ(classifier.see(5, 30.0, 90.0).most_likely, 2);
  EXPECT_FALSE(classifier.see(5, 30.0, 90.0, 1.0, false).valid);
  EXPECT_EQ(classifier.see(5, 30.0, 90.0).most_likely, 5);
}

// Its cylinders and rods load the platform alike, so that each has half of the evidence.
TEST(ModelClassifier, AcceptsALegWhoseLinksAreAlike) {
  const auto robot = std::make_shared<const Hexapod>(hexapod_robot());
  Classifier classifier({}, robot);
  ContactEvidence seen;
  seen.valid = true;
  seen.acquired = classifier.ticking.now();
  seen.log_evidence = ClassVector::Constant(classifier.count, -50.0);
  seen.log_evidence[BodyId::link1(2).index()] = -40.0;
  seen.log_evidence[BodyId::link2(2).index()] = -39.5;
  seen.residual = ClassVector::Constant(classifier.count, 1.0);
  seen.force = ClassVector::Constant(classifier.count, 20.0);
  const ContactClassification said = classifier.see(seen);
  EXPECT_TRUE(said.accepted);
  EXPECT_EQ(said.most_likely, BodyId::link1(2).index());
  EXPECT_EQ(said.probability[BodyId::link2(2).index()], 0.0);
  EXPECT_NEAR(said.probability.sum(), 1.0, 1e-12);
}

TEST(ModelClassifier, SaysNothingWithoutEvidenceAndNeverAllocates) {
  Classifier classifier;
  const test::AllocationCounter allocations;
  classifier.ticking.set(classifier.phase, ContactPhase{true, {}});
  classifier.ticking.tick();
  EXPECT_FALSE(classifier.ticking.get(classifier.block.classification).valid);
  EXPECT_TRUE(classifier.see(1, 10.0, 20.0).valid);
  EXPECT_EQ(allocations.count(), 0);
}

TEST(ModelClassifier, ServesEvidenceThatCannotBeTrue) {
  Classifier classifier;
  const ContactClassification said = classifier.see(3, -1e6, 0.0);
  EXPECT_TRUE(said.valid);
  EXPECT_NEAR(said.probability.sum(), 1.0, 1e-12);
  EXPECT_FALSE(said.accepted);
}

TEST(ModelClassifier, AsksForSettingsInTheirRange) {
  const auto robot = test::touched_rig();
  EXPECT_THROW(ModelClassifier(robot, {.accept = 1.1}), SetupError);
  EXPECT_THROW(ModelClassifier(robot, {.window = -1ms}), SetupError);
}

}  // namespace
}  // namespace flinch
