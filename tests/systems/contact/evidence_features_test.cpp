#include "systems/contact/evidence_features.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "systems/framework/random.h"
#include "tests/support/allocations.h"

namespace flinch {
namespace {

using Values = NeuralNetwork::Values;
const ContactClasses classes(7, 3);

ContactEvidence random_evidence(std::uint64_t seed) {
  RandomGenerator random(seed);
  ContactEvidence evidence;
  evidence.valid = true;
  for (ClassVector* entries : {&evidence.log_evidence, &evidence.residual, &evidence.location,
                               &evidence.force, &evidence.approach}) {
    entries->resize(classes.count());
    for (double& entry : *entries) entry = random.uniform(0.0, 1.0);
  }
  evidence.log_evidence *= 10.0;
  evidence.force *= 50.0;
  return evidence;
}

/// The same evidence with legs 1 and 3 exchanged.
ContactEvidence exchanged(const ContactEvidence& evidence) {
  ContactEvidence result = evidence;
  for (const auto& [from, to] : {std::pair(1, 5), std::pair(2, 6), std::pair(5, 1), std::pair(6, 2),
                                 std::pair(7, 9), std::pair(9, 7)}) {
    result.log_evidence[to] = evidence.log_evidence[from];
    result.residual[to] = evidence.residual[from];
    result.location[to] = evidence.location[from];
    result.force[to] = evidence.force[from];
    result.approach[to] = evidence.approach[from];
  }
  return result;
}

TEST(EvidenceFeatures, FollowTheLegsWhereverTheyStand) {
  const ContactEvidence evidence = random_evidence(1);
  Values columns, other;
  const ContactEvidence change = random_evidence(11), before = random_evidence(12);
  const ContactEvidence mirrored[] = {exchanged(evidence), exchanged(change), exchanged(before)};
  evidence_features(classes, {evidence, change, before, 30.0}, columns);
  evidence_features(classes, {mirrored[0], mirrored[1], mirrored[2], 30.0}, other);
  ASSERT_EQ(columns.cols(), 10);
  EXPECT_EQ(columns.col(0), other.col(0));
  EXPECT_EQ(columns.col(1), other.col(5));
  EXPECT_EQ(columns.col(6), other.col(2));
  EXPECT_EQ(columns.col(9), other.col(7));
  EXPECT_EQ(columns.col(3), other.col(3));
}

TEST(EvidenceFeatures, AreNamedOnceEach) {
  const auto names = evidence_feature_names();
  EXPECT_EQ(names.size(), static_cast<std::size_t>(evidence_feature_count));
  Values columns;
  const ContactEvidence whole = random_evidence(2), change = random_evidence(5), before = random_evidence(6);
  evidence_features(classes, {whole, change, before, 30.0}, columns);
  EXPECT_EQ(columns.rows(), evidence_feature_count);
  EXPECT_EQ(names[3].name, "is_clamping");
  EXPECT_EQ(columns(3, 8), 1.0);
  EXPECT_EQ(names[4].name, "own_log_share");
  // ln of each class' share of the likelihood: shares add up to 1.
  EXPECT_NEAR(columns.row(4).array().exp().sum(), 1.0, 1e-9);
  EXPECT_EQ(names[31].name, "change_own_log_share");
  EXPECT_NEAR(columns.row(31).array().exp().sum(), 1.0, 1e-9);
  EXPECT_EQ(names[59].name, "change_before_own_residual");
  EXPECT_NEAR(columns(59, 7), std::sqrt(before.residual[7]), 1e-12);
  EXPECT_EQ(names.back().name, "log_total_force");
  EXPECT_NEAR(columns(evidence_feature_count - 1, 4), std::asinh(3.0), 1e-15);
}

TEST(EvidenceFeatures, AreBoundedWhateverTheEvidence) {
  ContactEvidence evidence = random_evidence(3);
  Values columns;
  evidence.log_evidence.setConstant(-1e6);
  evidence.log_evidence[2] = 1e5;
  evidence.residual.setConstant(1e12);
  evidence.approach.setConstant(-1e9);
  evidence.force[1] = std::numeric_limits<double>::infinity();
  evidence.location[1] = std::numeric_limits<double>::quiet_NaN();
  evidence_features(classes, {evidence, evidence, evidence, 1e300}, columns);
  EXPECT_TRUE(columns.allFinite());
  EXPECT_LT(columns.cwiseAbs().maxCoeff(), 1000.0);
  const ContactEvidence none;
  evidence_features(classes, {evidence, evidence, none, 30.0}, columns);
  EXPECT_TRUE(columns.isZero());
  evidence_features(classes, {none, evidence, evidence, 30.0}, columns);
  EXPECT_TRUE(columns.isZero());
}

TEST(EvidenceFeatures, DoNotAllocate) {
  const ContactEvidence evidence = random_evidence(4);
  Values columns;
  const test::AllocationCounter allocations;
  evidence_features(classes, {evidence, evidence, evidence, 30.0}, columns);
  EXPECT_EQ(allocations.count(), 0);
}

}  // namespace
}  // namespace flinch
