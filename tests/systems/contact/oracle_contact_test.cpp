#include "systems/contact/oracle_contact.h"

#include <gtest/gtest.h>

#include "systems/framework/diagram_builder.h"
#include "tests/support/ticking.h"

namespace flinch {
namespace {

TEST(OracleContact, HandsOnWhatItIsToldAtTheSameTick) {
  DiagramBuilder builder("test", 1ms);
  auto& told = builder.add<OracleContact>("told");
  const auto classification = builder.export_input("classification", told.told_classification);
  const auto location = builder.export_input("location", told.told_location);
  test::Ticking ticking(builder);
  ContactClassification touched;
  touched.valid = true;
  touched.most_likely = 4;
  ContactLocation place;
  place.valid = true;
  place.fraction = 0.25;
  ticking.set(classification, touched);
  ticking.set(location, place);
  ticking.tick();
  EXPECT_EQ(ticking.get(told.classification).most_likely, 4);
  EXPECT_EQ(ticking.get(told.location).fraction, 0.25);
}

}  // namespace
}  // namespace flinch
