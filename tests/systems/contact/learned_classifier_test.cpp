#include "systems/contact/learned_classifier.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "systems/contact/evidence_features.h"
#include "systems/foundation/setup_error.h"
#include "systems/robot/planar_rrr.h"
#include "systems/robot/planar_rrr_presets.h"
#include "tests/support/allocations.h"
#include "tests/support/problems_of.h"
#include "tests/support/ticking.h"

namespace flinch {
namespace {

std::shared_ptr<const PlanarRrr> rig() {
  return std::make_shared<PlanarRrr>(rig_robot(RigGeometry::nominal, RigFriction::none));
}

/// Takes every class for as likely as its evidence says: a score that is own_log_share.
std::shared_ptr<const NeuralNetwork> takes_evidence_as_it_is() {
  NetworkParameters parameters;
  NetworkLayer& layer = parameters.layers.emplace_back();
  layer.weights.setZero(1, evidence_feature_count);
  layer.weights(0, 4) = 1.0;
  layer.bias.setZero(1);
  parameters.result = NetworkResult::softmax_of_rows;
  return std::make_shared<NeuralNetwork>(parameters);
}

struct Classifier {
  explicit Classifier(const LearnedClassifierSettings& settings = {.network = takes_evidence_as_it_is()})
      : block(builder.add<LearnedClassifier>("classifier", rig(), settings)),
        phase(builder.export_input("phase", block.phase)),
        kinematics(builder.export_input("kinematics", block.kinematics)),
        evidence(builder.export_input("evidence", block.evidence)),
        growth(builder.export_input("growth_evidence", block.growth_evidence)),
        course(builder.export_input("course", block.course)),
        ticking(builder) {
    Kinematics home;
    rig()->kinematics(rig()->home_pose(), PlatformVector::Zero(3), home);
    ticking.set(kinematics, home);
  }

  /// One class is e^`strength` times as likely as each other one.
  ContactClassification see(int number, double strength, bool active = true, double residual = 1.0) {
    ContactEvidence seen;
    seen.valid = std::isfinite(strength);
    seen.log_evidence = ClassVector::Constant(10, -50.0);
    seen.log_evidence[number] += strength;
    seen.residual = ClassVector::Constant(10, residual);
    seen.location = seen.approach = ClassVector::Zero(10);
    seen.force = ClassVector::Constant(10, 30.0);
    ticking.set(evidence, seen);
    ticking.set(growth, has_grown ? seen : ContactEvidence());
    ContactWindow told;
    told.valid = has_course;
    told.moments.fill({Eigen::Vector3d(30.0, 0.0, 1.0), Eigen::Vector3d(0.3, 0.1, 0.0)});
    ticking.set(course, told);
    if (active && !active_) since_ = ticking.now();
    active_ = active;
    ticking.set(phase, ContactPhase{active, since_});
    ticking.tick();
    return ticking.get(block.classification);
  }

  DiagramBuilder builder;
  LearnedClassifier& block;
  InputPort<ContactPhase> phase;
  InputPort<Kinematics> kinematics;
  InputPort<ContactEvidence> evidence, growth;
  InputPort<ContactWindow> course;
  test::Ticking ticking;
  bool has_grown = true, has_course = true;  ///< they are known

 private:
  bool active_ = false;
  Time since_{};
};

TEST(LearnedClassifier, SaysWhatItsNetworkSays) {
  const ContactClassification said = Classifier().see(4, std::log(81.0));
  ASSERT_TRUE(said.valid);
  EXPECT_EQ(said.most_likely, 4);
  EXPECT_NEAR(said.probability[4], 81.0 / 90.0, 1e-12);
  EXPECT_NEAR(said.probability.sum(), 1.0, 1e-12);
}

TEST(LearnedClassifier, AcceptsWhatIsSureEnoughAndOneContact) {
  EXPECT_TRUE(Classifier().see(4, std::log(81.1)).accepted);
  EXPECT_FALSE(Classifier().see(4, std::log(80.9)).accepted);
  const ContactClassification several = Classifier().see(4, 9.0, true, 15.1);
  EXPECT_TRUE(several.several_contacts);
  EXPECT_EQ(several.residual, 15.1);
  EXPECT_FALSE(several.accepted);
}

TEST(LearnedClassifier, DoesNotAcceptWhatItSaysOfWrenchesOfWhichItHasNotLearned) {
  const double size = std::hypot(30.0 / 2.0, 1.0 / 0.2);  // of that of see()
  for (const double least : {0.99 * size, 1.01 * size}) {
    const ContactClassification said =
        Classifier({.network = takes_evidence_as_it_is(), .least_wrench = least}).see(4, 9.0);
    EXPECT_TRUE(said.valid);
    EXPECT_EQ(said.accepted, size >= least);
  }
}

TEST(LearnedClassifier, StandsByWhatItSaidUntilTheContactEnds) {
  Classifier classifier;
  EXPECT_FALSE(classifier.see(2, 5.0, false).valid);
  for (int tick = 0; tick <= 10; ++tick) EXPECT_EQ(classifier.see(2, 5.0).most_likely, 2);
  EXPECT_EQ(classifier.see(3, 5.0).most_likely, 2) << "after the window";
  EXPECT_FALSE(classifier.see(3, 5.0, false).valid);
  EXPECT_EQ(classifier.see(3, 5.0).most_likely, 3);
}

TEST(LearnedClassifier, LeavesItsAnswerWhereThereIsNoEvidence) {
  Classifier classifier;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(classifier.see(2, nan).valid);
  EXPECT_EQ(classifier.see(2, 5.0).most_likely, 2);
  EXPECT_EQ(classifier.see(5, nan).most_likely, 2);
  classifier.has_grown = false;
  EXPECT_EQ(classifier.see(5, 5.0).most_likely, 2);
  classifier.has_grown = true;
  classifier.has_course = false;
  EXPECT_EQ(classifier.see(5, 5.0).most_likely, 2);
  classifier.has_course = true;
  EXPECT_EQ(classifier.see(5, 5.0).most_likely, 5);
}

TEST(LearnedClassifier, DoesNotAllocate) {
  Classifier classifier;
  classifier.see(2, 5.0);
  const test::AllocationCounter allocations;
  classifier.see(3, 5.0);
  EXPECT_EQ(allocations.count(), 0);
}

TEST(LearnedClassifier, NeedsANetworkThatIsToldTheEvidence) {
  EXPECT_THAT(test::problems_of([] { LearnedClassifier(rig(), {}); }),
              testing::ElementsAre("learned classifier: there is no network"));
  NetworkParameters other;
  other.layers.push_back({Eigen::MatrixXd::Zero(2, 6), Eigen::VectorXd::Zero(2), Activation::none});
  EXPECT_THAT(test::problems_of(
                  [&] { LearnedClassifier(rig(), {.network = std::make_shared<NeuralNetwork>(other)}); }),
              testing::ElementsAre(
                  "learned classifier: the network answers another question than which class was touched"));
}

}  // namespace
}  // namespace flinch
