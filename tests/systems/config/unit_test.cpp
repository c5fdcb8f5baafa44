#include "systems/config/unit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "systems/config/range.h"

namespace flinch {
namespace {

const std::vector<Unit> all_units = {unit::none,
                                     unit::m,
                                     unit::m_per_s,
                                     unit::m_per_s2,
                                     unit::m_per_s3,
                                     unit::rad,
                                     unit::rad_per_s,
                                     unit::rad_per_s2,
                                     unit::rad_per_s3,
                                     unit::s,
                                     unit::per_s,
                                     unit::per_s2,
                                     unit::Hz,
                                     unit::kg,
                                     unit::kg_m2,
                                     unit::N,
                                     unit::N_per_s,
                                     unit::N_per_m,
                                     unit::Ns_per_m,
                                     unit::Nm,
                                     unit::Nm_per_s,
                                     unit::Nm_per_rad,
                                     unit::Nms_per_rad,
                                     unit::A,
                                     unit::Nm_per_A,
                                     unit::m_per_s2_per_sqrt_Hz,
                                     unit::rad_per_s_per_sqrt_Hz};

double si(std::string_view key, double value) { return find_key_unit(key)->to_si(value); }

TEST(KeyUnits, BeginWithTheSiUnitItselfAndAreAllOfItsQuantity) {
  for (const Unit& unit : all_units) {
    const auto written = key_units(unit);
    ASSERT_FALSE(written.empty()) << unit.key;
    EXPECT_EQ(written.front().key, unit.key);
    EXPECT_EQ(written.front().to_si(0.1), 0.1);
    for (const KeyUnit& other : written) EXPECT_EQ(other.si, unit) << other.key;
  }
}

TEST(KeyUnits, ConvertThereAndBack) {
  for (const Unit& unit : all_units) {
    for (const KeyUnit& written : key_units(unit)) {
      EXPECT_NEAR(written.from_si(written.to_si(0.7)), 0.7, 1e-15) << written.key;
    }
  }
}

TEST(KeyUnits, HaveTheSizesOfThePhysicsBook) {
  EXPECT_EQ(si("deg", 180.0), std::numbers::pi);
  EXPECT_EQ(si("mm", 97.0), 0.097);
  EXPECT_EQ(si("cm", 14.0), 0.14);
  EXPECT_EQ(si("ms", 1.0), 0.001);
  EXPECT_EQ(si("us", 250.0), 250e-6);
  EXPECT_EQ(si("g", 642.0), 0.642);
  EXPECT_DOUBLE_EQ(si("kg_cm2", 36.7513), 0.00367513);
  EXPECT_EQ(si("N_per_mm", 6.0), 6000.0);
  EXPECT_EQ(si("kN_per_m", 6.0), 6000.0);
  EXPECT_EQ(si("kHz", 1.6), 1600.0);
  EXPECT_DOUBLE_EQ(si("Nm_per_deg", 1.0), 57.29577951308232);
  EXPECT_DOUBLE_EQ(si("deg_per_s", 3.0), 0.05235987755982989);
}

TEST(KeyUnits, WithTheSameEndMeanTheSameQuantityEverywhere) {
  for (const Unit& unit : all_units) {
    for (const KeyUnit& written : key_units(unit)) EXPECT_EQ(find_key_unit(written.key)->si, unit);
  }
  EXPECT_EQ(find_key_unit("lbs"), nullptr);
}

TEST(KeyUnits, AreListedForAKey) {
  EXPECT_EQ(possible_keys("mass", unit::kg), "mass_kg or mass_g");
  EXPECT_EQ(possible_keys("link", unit::m), "link_m, link_mm or link_cm");
  EXPECT_EQ(possible_keys("damping", unit::Nms_per_rad), "damping_Nms_per_rad");
  EXPECT_EQ(possible_keys("restitution", unit::none), "restitution");
}

TEST(Range, ContainsNoNumberThatIsNotFinite) {
  for (const Range& range : {any_number, positive, not_negative, fraction}) {
    EXPECT_FALSE(range.contains(std::nan("")));
    EXPECT_FALSE(range.contains(HUGE_VAL));
    EXPECT_FALSE(range.contains(-HUGE_VAL));
    EXPECT_TRUE(range.contains(0.5));
  }
}

TEST(Range, ContainsItsBoundsOnlyWhereTheyAreIncluded) {
  EXPECT_FALSE(positive.contains(0.0));
  EXPECT_TRUE(not_negative.contains(0.0));
  EXPECT_FALSE(not_negative.contains(-1e-300));
  EXPECT_TRUE(fraction.contains(1.0));
  EXPECT_FALSE(fraction.contains(1.0000001));
  EXPECT_TRUE(between(-2.0, 3.0).contains(-2.0));
  EXPECT_FALSE((Range{.high = 3.0, .high_included = false}).contains(3.0));
}

TEST(Range, StatesItsBoundsInTheUnitOfTheFile) {
  const KeyUnit& degrees = *find_key_unit("deg");
  const KeyUnit& metres = *find_key_unit("m");
  EXPECT_EQ(between(0.0, std::numbers::pi).requirement(degrees), "lie between 0 and 180");
  EXPECT_EQ(positive.requirement(degrees), "be positive");
  EXPECT_EQ(not_negative.requirement(degrees), "not be negative");
  EXPECT_EQ(fraction.requirement(metres), "lie between 0 and 1");
  EXPECT_EQ((Range{.low = 2.0}).requirement(metres), "be at least 2");
  EXPECT_EQ((Range{.high = 2.0}).requirement(metres), "be at most 2");
  EXPECT_EQ((Range{.low = 0.0, .high = 1.0, .low_included = false}).requirement(metres),
            "be greater than 0 and at most 1");
}

}  // namespace
}  // namespace flinch
