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

LegCourses random_courses(std::uint64_t seed) {
  RandomGenerator random(seed);
  LegCourses courses{};
  for (LegHistory& course : courses) {
    course.elbow_cosine = random.uniform(-1.0, 1.0);
    for (LegMoment& moment : course.moments) {
      for (double* number : {&moment.link1_force, &moment.link2_force, &moment.other_force,
                             &moment.link1_speed, &moment.link2_speed})
        *number = random.normal();
    }
  }
  return courses;
}

TEST(EvidenceFeatures, FollowTheLegsWhereverTheyStand) {
  const ContactEvidence evidence = random_evidence(1), growth = random_evidence(11);
  const ContactEvidence mirrored[] = {exchanged(evidence), exchanged(growth)};
  LegCourses courses = random_courses(12);
  Values columns, other;
  evidence_features(classes, {evidence, growth, courses, 30.0}, columns);
  std::swap(courses[0], courses[2]);
  evidence_features(classes, {mirrored[0], mirrored[1], courses, 30.0}, other);
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
  const ContactEvidence whole = random_evidence(2), growth = random_evidence(5);
  const LegCourses courses = random_courses(6);
  evidence_features(classes, {whole, growth, courses, 30.0}, columns);
  EXPECT_EQ(columns.rows(), evidence_feature_count);
  EXPECT_EQ(names[3].name, "is_clamping");
  EXPECT_EQ(columns(3, 8), 1.0);
  EXPECT_EQ(names[4].name, "own_log_share");
  // ln of each class' share of the likelihood: shares add up to 1.
  EXPECT_NEAR(columns.row(4).array().exp().sum(), 1.0, 1e-9);
  EXPECT_EQ(names[31].name, "growth_own_log_share");
  EXPECT_NEAR(columns.row(31).array().exp().sum(), 1.0, 1e-9);
  EXPECT_EQ(names[32].name, "growth_own_residual");
  EXPECT_NEAR(columns(32, 7), std::sqrt(growth.residual[7]), 1e-12);
  EXPECT_EQ(names[58].name, "log_total_force");
  EXPECT_NEAR(columns(58, 4), std::asinh(3.0), 1e-15);
  // Leg 2: its second link, and its gap.
  EXPECT_EQ(names[60].name, "link2_force_0ms_ago");
  EXPECT_NEAR(columns(60, 4), std::asinh(courses[1].moments[0].link2_force / 5.0), 1e-15);
  EXPECT_EQ(columns(60, 8), columns(60, 4));
  EXPECT_EQ(names[evidence_feature_count - 3].name, "link1_speed_45ms_ago");
  EXPECT_NEAR(columns(evidence_feature_count - 3, 8), courses[1].moments.back().link1_speed / 0.3, 1e-12);
  EXPECT_EQ(names.back().name, "elbow_cosine");
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
  LegCourses courses = random_courses(7);
  courses[0].moments[2] = {1e300, -1e300, std::numeric_limits<double>::infinity(), 1e9, -1e9};
  courses[1].elbow_cosine = std::numeric_limits<double>::quiet_NaN();
  evidence_features(classes, {evidence, evidence, courses, 1e300}, columns);
  EXPECT_TRUE(columns.allFinite());
  EXPECT_LT(columns.cwiseAbs().maxCoeff(), 1000.0);
  const ContactEvidence none;
  evidence_features(classes, {evidence, none, courses, 30.0}, columns);
  EXPECT_TRUE(columns.isZero());
  evidence_features(classes, {none, evidence, courses, 30.0}, columns);
  EXPECT_TRUE(columns.isZero());
}

TEST(EvidenceFeatures, DoNotAllocate) {
  const ContactEvidence evidence = random_evidence(4);
  const LegCourses courses = random_courses(4);
  Values columns;
  const test::AllocationCounter allocations;
  evidence_features(classes, {evidence, evidence, courses, 30.0}, columns);
  EXPECT_EQ(allocations.count(), 0);
}

}  // namespace
}  // namespace flinch
