#include "systems/signals/contact_classes.h"

#include <gtest/gtest.h>

namespace flinch {
namespace {

TEST(ContactClasses, AreTheBodiesAndThenAClampingOfEachLeg) {
  const ContactClasses classes(7, 3);
  ASSERT_EQ(classes.count(), 10);
  const std::string names[] = {"platform",   "leg1_link1", "leg1_link2",    "leg2_link1",    "leg2_link2",
                               "leg3_link1", "leg3_link2", "leg1_clamping", "leg2_clamping", "leg3_clamping"};
  const int legs[] = {-1, 0, 0, 1, 1, 2, 2, 0, 1, 2};
  for (int number = 0; number < 10; ++number) {
    EXPECT_EQ(classes.name(number), names[number]);
    EXPECT_EQ(classes.leg(number), legs[number]);
    EXPECT_EQ(classes.is_clamping(number), number >= 7);
  }
  EXPECT_EQ(classes.clamping(2), 9);
  EXPECT_EQ(ContactClasses::collision(BodyId::link2(1)), 4);
}

TEST(ContactClasses, HaveNoNameForWhatTheyDoNotContain) {
  const ContactClasses classes(7, 3);
  for (const int number : {-1, 10}) {
    EXPECT_FALSE(classes.contains(number));
    EXPECT_FALSE(classes.is_clamping(number));
    EXPECT_EQ(classes.name(number), "");
  }
}

TEST(ContactClassification, HasNoConfidenceBeforeItSaysAnything) {
  ContactClassification classification;
  EXPECT_EQ(classification.confidence(), 0.0);
  classification.most_likely = 1;
  classification.probability = ClassVector{{0.2, 0.7, 0.1}};
  EXPECT_EQ(classification.confidence(), 0.7);
}

}  // namespace
}  // namespace flinch
