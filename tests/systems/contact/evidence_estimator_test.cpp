#include "systems/contact/evidence_estimator.h"

#include "systems/foundation/setup_error.h"
#include "tests/support/allocations.h"
#include "tests/support/ticking.h"
#include "tests/systems/contact/touched_robot.h"

namespace flinch {
namespace {

TEST(EvidenceEstimator, WeighsInTheFirstMomentsOfAContactAndRestsOtherwise) {
  const auto robot = test::touched_rig();
  DiagramBuilder builder;
  auto& block =
      builder.add<EvidenceEstimator>("evidence", robot, TouchHypothesesSettings{}, WrenchUncertainty{}, 5ms);
  const auto phase = builder.export_input("phase", block.phase);
  const auto kinematics = builder.export_input("kinematics", block.kinematics);
  const auto wrench = builder.export_input("wrench", block.wrench);
  test::Ticking ticking(builder);
  const Kinematics k = test::at_home(*robot);
  ticking.set(kinematics, k);
  const auto see = [&](bool active, const WrenchEstimate& estimate) {
    ticking.set(phase, ContactPhase{active, {}});
    ticking.set(wrench, estimate);
    ticking.tick();
    return ticking.get(block.evidence);
  };
  const WrenchEstimate push = test::estimate_of(k, PlatformVector{{30.0, 0.0, 0.0}}, 7ms);
  WrenchEstimate lost = push;
  lost.valid = false;
  const test::AllocationCounter allocations;
  EXPECT_FALSE(see(false, push).valid);
  const ContactEvidence evidence = see(true, push);
  EXPECT_TRUE(evidence.valid);
  EXPECT_EQ(evidence.acquired, 7ms);
  EXPECT_EQ(evidence.log_evidence.size(), 10);
  EXPECT_FALSE(see(true, lost).valid);
  for (int tick = 0; tick < 5; ++tick) see(true, push);
  EXPECT_TRUE(see(true, lost).valid) << "the window is over, and what was weighed in it stands";
  EXPECT_EQ(allocations.count(), 0);
}

TEST(EvidenceEstimator, AsksForNoiseThatIsPositive) {
  EXPECT_THROW(EvidenceEstimator(test::touched_rig(), {}, {.force = 0.0}, 10ms), SetupError);
}

}  // namespace
}  // namespace flinch
