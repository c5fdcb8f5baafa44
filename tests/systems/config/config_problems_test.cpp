#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <numbers>

#include "systems/config/config_reader.h"
#include "tests/systems/config/problems_of.h"

/// Every way in which a file can be wrong: where, what was found, what would be right.
namespace flinch {
namespace {

using test::Problems;
using test::problems_of;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

Problems problems_with_number(const std::string& text, const Unit& unit = unit::kg,
                              const Range& range = any_number) {
  return problems_of(text, [&](ConfigReader& reader) {
    double mass = 1.0;
    reader.required().number("mass", unit, mass, range);
  });
}

TEST(WrongFile, IsEmptyOrNoMapping) {
  const auto nothing = [](ConfigReader&) {};
  EXPECT_THAT(problems_of("", nothing),
              ElementsAre("a.yaml: is empty; it must be a mapping, of lines such as 'key: value'"));
  EXPECT_THAT(problems_of("# nothing yet\n", nothing),
              ElementsAre(::testing::StartsWith("a.yaml: is empty;")));
  EXPECT_THAT(problems_of("\n- 1\n- 2\n", nothing),
              ElementsAre("a.yaml:2: is a list; it must be a mapping, of lines such as 'key: value'"));
  EXPECT_THAT(problems_of("mass 3\n", nothing), ElementsAre(::testing::StartsWith("a.yaml:1: is 'mass 3';")));
}

// ---------------------------------------------------------------- keys

TEST(WrongUnit, IsToldWithTheRightOnes) {
  EXPECT_THAT(problems_with_number("\nmass_m: 1"),
              ElementsAre("a.yaml:2: mass_m: has the wrong unit, m; write mass_kg or mass_g"));
  EXPECT_THAT(
      problems_with_number("mass_Nms_per_rad: 1", unit::Nm),
      ElementsAre("a.yaml:1: mass_Nms_per_rad: has the wrong unit, Nms_per_rad; write mass_Nm or mass_mNm"));
}

TEST(WrongUnit, MayBeNone) {
  EXPECT_THAT(problems_with_number("mass: 1"),
              ElementsAre("a.yaml:1: mass: has no unit; write mass_kg or mass_g"));
}

TEST(WrongUnit, MayBeOneWhereNoneBelongs) {
  EXPECT_THAT(problems_with_number("mass_kg: 1", unit::none),
              ElementsAre("a.yaml:1: mass_kg: has a unit, kg; write mass"));
}

TEST(WrongUnit, IsToldForAnOptionalValueToo) {
  EXPECT_THAT(problems_of("link1_length_kg: 0.5",
                          [](ConfigReader& reader) {
                            double length = 0.0;
                            reader.number("link1", unit::kg, length);
                            reader.number("link1_length", unit::m, length);
                          }),
              ElementsAre("a.yaml:1: link1_length_kg: has the wrong unit, kg; write link1_length_m, "
                          "link1_length_mm or link1_length_cm"));
}

TEST(Units, TellTwoQuantitiesOfOneNameApart) {
  double force = 0.0, moment = 0.0;
  EXPECT_THAT(problems_of("stiffness_N_per_m: 2000\nstiffness_Nm_per_rad: 85\n",
                          [&](ConfigReader& reader) {
                            reader.required().number("stiffness", unit::N_per_m, force);
                            reader.required().number("stiffness", unit::Nm_per_rad, moment);
                          }),
              IsEmpty());
  EXPECT_EQ(force, 2000.0);
  EXPECT_EQ(moment, 85.0);
}

TEST(UnknownKey, IsToldWithTheNearestKnownOne) {
  EXPECT_THAT(problems_with_number("mass_kg: 1\nmas_kg: 2\n"),
              ElementsAre("a.yaml:2: mas_kg: is not a known key; did you mean 'mass_kg'?"));
}

TEST(UnknownKey, IsToldWithAllKnownOnesIfNoneIsNear) {
  EXPECT_THAT(problems_with_number("mass_kg: 1\ncolour_of_paint: red\n"),
              ElementsAre("a.yaml:2: colour_of_paint: is not a known key; known are: mass_kg"));
}

TEST(UnknownKey, ThatMisspellsAMissingOneIsToldOnce) {
  EXPECT_THAT(problems_with_number("mas_kg: 2\n"),
              ElementsAre("a.yaml:1: mas_kg: is not a known key; did you mean 'mass_kg'?"));
}

TEST(UnknownKey, IsFoundInSections) {
  EXPECT_THAT(problems_of("legs:\n- mass_kg: 1\n- mass_kg: 2\n  bogus: 3\n",
                          [](ConfigReader& reader) {
                            double mass = 0.0;
                            for (ConfigReader& leg : reader.sections("legs"))
                              leg.number("mass", unit::kg, mass);
                          }),
              ElementsAre("a.yaml:4: legs[1].bogus: is not a known key; known are: mass_kg"));
}

TEST(UnknownKey, IsToldWithOneThatWasOnlyLookedFor) {
  const auto look = [](ConfigReader& reader) { reader.has("contact"); };
  EXPECT_THAT(problems_of("contcat: 1", look),
              ElementsAre("a.yaml:1: contcat: is not a known key; did you mean 'contact'?"));
  EXPECT_THAT(problems_of("contact: 1", look),
              ElementsAre("a.yaml:1: contact: has no effect here; leave it out"));
}

TEST(MissingKey, IsToldWhereItsSectionBegins) {
  EXPECT_THAT(problems_with_number("{}"), ElementsAre("a.yaml:1: mass_kg: is missing; it must be given"));
  EXPECT_THAT(problems_of("a: 1\nlegs:\n  - b: 1\n  - b: 2\n",
                          [](ConfigReader& reader) {
                            int a = 0;
                            double mass = 0.0;
                            reader.integer("a", a);
                            for (ConfigReader& leg : reader.sections("legs")) {
                              leg.integer("b", a);
                              leg.required().number("mass", unit::kg, mass);
                            }
                          }),
              ElementsAre("a.yaml:3: legs[0].mass_kg: is missing; it must be given",
                          "a.yaml:4: legs[1].mass_kg: is missing; it must be given"));
}

TEST(RepeatedKey, IsToldWithBothLines) {
  EXPECT_THAT(problems_with_number("mass_kg: 1\n\nmass_kg: 2\n"),
              ElementsAre("a.yaml:3: mass_kg: is given already on line 1; keep one of them"));
}

TEST(RepeatedKey, MayHaveAnotherUnit) {
  EXPECT_THAT(problems_with_number("mass_kg: 1\nmass_g: 1000\n"),
              ElementsAre("a.yaml:2: mass_g: means the same as mass_kg on line 1; keep one of them"));
}

TEST(Alternatives, MustBeGivenExactlyOnce) {
  const auto read = [](ConfigReader& reader) {
    reader.one_of({"base_parameters", "bodies"});
    reader.section("bodies");
  };
  EXPECT_THAT(problems_of("{}", read),
              ElementsAre("a.yaml:1: has none of base_parameters, bodies; it must have one of them"));
  EXPECT_THAT(
      problems_of("bodies: {}\nbase_parameters: {}\n", read),
      ElementsAre("a.yaml:1: has more than one of base_parameters, bodies; it must have only one of them"));
  EXPECT_THAT(problems_of("bodies: {}\n", read), IsEmpty());
}

// ---------------------------------------------------------------- values

TEST(WrongNumber, IsNotFinite) {
  for (const std::string value : {".nan", ".inf", "-.inf", ".NaN", "nan", "inf", "-inf"}) {
    EXPECT_THAT(problems_with_number("mass_kg: " + value),
                ElementsAre("a.yaml:1: mass_kg: is " + value + "; it must be a finite number"));
  }
}

TEST(WrongNumber, IsOfAnotherType) {
  EXPECT_THAT(problems_with_number("mass_kg: heavy"),
              ElementsAre("a.yaml:1: mass_kg: is 'heavy'; it must be a number"));
  EXPECT_THAT(problems_with_number("mass_kg: 2 kg"),
              ElementsAre("a.yaml:1: mass_kg: is '2 kg'; it must be a number"));
  EXPECT_THAT(problems_with_number("mass_kg: 0x10"),
              ElementsAre("a.yaml:1: mass_kg: is '0x10'; it must be a number"));
  EXPECT_THAT(problems_with_number("mass_kg: true"),
              ElementsAre("a.yaml:1: mass_kg: is 'true'; it must be a number"));
  EXPECT_THAT(problems_with_number("mass_kg:"),
              ElementsAre("a.yaml:1: mass_kg: is empty; it must be a number"));
  EXPECT_THAT(problems_with_number("mass_kg: [1]"),
              ElementsAre("a.yaml:1: mass_kg: is a list; it must be a number"));
  EXPECT_THAT(problems_with_number("mass_kg: {a: 1}"),
              ElementsAre("a.yaml:1: mass_kg: is a mapping; it must be a number"));
  EXPECT_THAT(problems_with_number("mass_kg: '2'"),
              ElementsAre("a.yaml:1: mass_kg: is the text \"2\"; it must be a number, not in quotes"));
  EXPECT_THAT(problems_with_number("mass_kg: 0,5"),
              ElementsAre("a.yaml:1: mass_kg: is '0,5'; it must be a number, with a decimal point"));
}

TEST(WrongNumber, IsTooLargeOrTooSmallForADouble) {
  EXPECT_THAT(problems_with_number("mass_kg: 1e999"), ElementsAre(::testing::HasSubstr("magnitude between")));
  EXPECT_THAT(problems_with_number("mass_kg: 1e-999"),
              ElementsAre(::testing::HasSubstr("magnitude between")));
  EXPECT_THAT(problems_with_number("mass_kN: 1e308", unit::N),
              ElementsAre("a.yaml:1: mass_kN: is 1e308; it must be a finite number"));
}

TEST(WrongNumber, IsOfASizeThatNobodyCanComputeWith) {
  for (const std::string value : {"1e300", "-1e25", "1e-25", "-1e-300"}) {
    EXPECT_THAT(problems_with_number("mass_kg: " + value),
                ElementsAre("a.yaml:1: mass_kg: is " + value +
                            "; it must be 0 or of a size between 1e-24 and 1e24 in SI"));
  }
  EXPECT_THAT(problems_with_number("mass_kN: 5e21", unit::N),
              ElementsAre(::testing::HasSubstr("of a size between")));
  for (const char* const value : {"0", "1e24", "-1e-24"})
    EXPECT_THAT(problems_with_number("mass_kg: " + std::string(value)), IsEmpty());
}

TEST(WrongNumber, IsOutOfRange) {
  EXPECT_THAT(problems_with_number("mass_kg: -0.5", unit::kg, positive),
              ElementsAre("a.yaml:1: mass_kg: is -0.5; it must be positive"));
  EXPECT_THAT(problems_with_number("mass_kg: 0", unit::kg, positive),
              ElementsAre("a.yaml:1: mass_kg: is 0; it must be positive"));
  EXPECT_THAT(problems_with_number("mass_g: -1", unit::kg, not_negative),
              ElementsAre("a.yaml:1: mass_g: is -1; it must not be negative"));
  EXPECT_THAT(problems_with_number("mass: 1.5", unit::none, fraction),
              ElementsAre("a.yaml:1: mass: is 1.5; it must lie between 0 and 1"));
}

TEST(WrongNumber, IsToldTheRangeInItsOwnUnit) {
  EXPECT_THAT(problems_with_number("mass_deg: 200", unit::rad, between(-std::numbers::pi, std::numbers::pi)),
              ElementsAre("a.yaml:1: mass_deg: is 200; it must lie between -180 and 180"));
}

TEST(WrongNumber, LeavesTheDefault) {
  double mass = 1.0;
  EXPECT_THAT(problems_of("mass_kg: -2",
                          [&](ConfigReader& reader) { reader.number("mass", unit::kg, mass, positive); }),
              ::testing::SizeIs(1));
  EXPECT_EQ(mass, 1.0);
}

TEST(WrongList, HasAnotherLengthOrWrongEntries) {
  const auto read = [](ConfigReader& reader) {
    std::array<double, 3> gain{};
    reader.numbers("gain", unit::per_s, gain, positive);
  };
  EXPECT_THAT(problems_of("gain_per_s: [20, 20]", read),
              ElementsAre("a.yaml:1: gain_per_s: is a list of 2; it must be a list of 3 numbers"));
  EXPECT_THAT(problems_of("gain_per_s: 20", read),
              ElementsAre("a.yaml:1: gain_per_s: is 20; it must be a list of 3 numbers"));
  EXPECT_THAT(problems_of("gain_per_s:\n  - 20\n  - .nan\n  - -1\n", read),
              ElementsAre("a.yaml:3: gain_per_s[1]: is .nan; it must be a finite number",
                          "a.yaml:4: gain_per_s[2]: is -1; it must be positive"));
}

TEST(WrongList, IsEmptyWhereAnyLengthWillDo) {
  EXPECT_THAT(problems_of("speeds_m_per_s: []",
                          [](ConfigReader& reader) {
                            std::vector<double> speeds;
                            reader.numbers("speeds", unit::m_per_s, speeds);
                          }),
              ElementsAre("a.yaml:1: speeds_m_per_s: is an empty list; it must be a list of numbers"));
}

TEST(WrongList, IsToldOnceThoughSeveralReadIt) {
  const auto read = [](ConfigReader& reader) {
    reader.sections("legs");
    reader.sections("legs");
  };
  EXPECT_THAT(problems_of("legs: []", read),
              ElementsAre("a.yaml:1: legs: is an empty list; it must be a list of mappings"));
  EXPECT_THAT(problems_of("legs: [{}, 3]", read),
              ElementsAre("a.yaml:1: legs[1]: is 3; it must be a mapping"));
}

TEST(WrongDuration, IsNoTimeOrLongerThanTimeGoes) {
  const auto read = [](ConfigReader& reader) {
    std::chrono::nanoseconds period{};
    reader.duration("period", period, positive);
  };
  EXPECT_THAT(problems_of("period_ms: 0", read),
              ElementsAre("a.yaml:1: period_ms: is 0; it must be positive"));
  EXPECT_THAT(problems_of("period_s: 1e12", read),
              ElementsAre("a.yaml:1: period_s: is 1e12; it must lie between -9e+09 and 9e+09"));
  EXPECT_THAT(
      problems_of("period_Hz: 3", read),
      ElementsAre("a.yaml:1: period_Hz: has the wrong unit, Hz; write period_s, period_ms or period_us"));
}

TEST(WrongWord, IsNoWholeNumber) {
  const auto read = [](ConfigReader& reader) {
    int count = 1;
    reader.integer("count", count, 1, 5);
  };
  EXPECT_THAT(problems_of("count: 2.5", read),
              ElementsAre("a.yaml:1: count: is 2.5; it must be a whole number"));
  EXPECT_THAT(problems_of("count: 6", read),
              ElementsAre("a.yaml:1: count: is 6; it must lie between 1 and 5"));
  EXPECT_THAT(problems_of("count: 9999999999", read),
              ElementsAre("a.yaml:1: count: is 9999999999; it must lie between 1 and 5"));
  EXPECT_THAT(problems_of("count: three", read),
              ElementsAre("a.yaml:1: count: is 'three'; it must be a whole number"));
}

TEST(WrongWord, IsNoSeedFlagOrText) {
  const auto read = [](ConfigReader& reader) {
    std::uint64_t seed = 0;
    bool noise = false;
    std::string name;
    reader.seed("seed", seed);
    reader.flag("noise", noise);
    reader.text("name", name);
  };
  EXPECT_THAT(problems_of("seed: -1\nnoise: yes\nname: [a]\n", read),
              ElementsAre("a.yaml:1: seed: is -1; it must be a whole number between 0 and 2^64 - 1",
                          "a.yaml:2: noise: is 'yes'; it must be true or false",
                          "a.yaml:3: name: is a list; it must be text"));
  EXPECT_THAT(problems_of("name: ''", read), ElementsAre("a.yaml:1: name: is empty; it must be text"));
}

TEST(WrongWord, IsToldWithTheNearestChoice) {
  const auto read = [](ConfigReader& reader) {
    int observer = 0;
    reader.choice("observer", observer, {{"momentum", 0}, {"kalman", 1}});
  };
  EXPECT_THAT(problems_of("observer: kalmann", read),
              ElementsAre("a.yaml:1: observer: is 'kalmann'; did you mean 'kalman'?"));
  EXPECT_THAT(problems_of("observer: Luenberger", read),
              ElementsAre("a.yaml:1: observer: is 'Luenberger'; known are: momentum, kalman"));
  EXPECT_THAT(problems_of("observer: [kalman]", read),
              ElementsAre("a.yaml:1: observer: is a list; known are: momentum, kalman"));
}

TEST(MissingWord, IsToldWithAllChoices) {
  const auto read = [](ConfigReader& reader) {
    int observer = 2;
    reader.required().choice("observer", observer, {{"momentum", 0}, {"kalman", 1}});
  };
  EXPECT_THAT(problems_of("{}", read),
              ElementsAre("a.yaml:1: observer: is missing; it must be one of momentum, kalman"));
}

TEST(MissingWord, IsToldWithKeysThatItWouldMakeKnown) {
  const auto read = [](ConfigReader& reader) {
    int observer = 0;
    double gain = 0.0;
    reader.choice("observer", observer, {{"momentum", 0}, {"kalman", 1}});
    if (observer == 0) reader.number("gain", unit::per_s, gain);
    if (observer == 1) reader.number("density", unit::N2_per_s, gain);
  };
  EXPECT_THAT(problems_of("density_N2_per_s: 3", read),
              ElementsAre("a.yaml:1: density_N2_per_s: is not a known key; known are: observer (momentum, "
                          "kalman), gain_per_s"));
  EXPECT_THAT(problems_of("{observer: kalman, density_N2_per_s: 3}", read), ElementsAre());
}

TEST(WrongSection, IsNoMapping) {
  const auto read = [](ConfigReader& reader) {
    double mass = 0.0;
    ConfigReader cover = reader.required().section("cover");
    cover.required().number("mass", unit::kg, mass);
    for (ConfigReader& leg : reader.required().sections("legs", 2))
      leg.required().number("mass", unit::kg, mass);
  };
  EXPECT_THAT(problems_of("cover: 3\nlegs: {mass_kg: 1}\n", read),
              ElementsAre("a.yaml:1: cover: is 3; it must be a mapping",
                          "a.yaml:2: legs: is a mapping; it must be a list of 2 mappings"));
  EXPECT_THAT(problems_of("{}", read), ElementsAre("a.yaml:1: cover: is missing; it must be given",
                                                   "a.yaml:1: legs: is missing; it must be given"));
  EXPECT_THAT(problems_of("cover: {mass_kg: 1}\nlegs: [{}, 4, {}]\n", read),
              ElementsAre("a.yaml:2: legs: is a list of 3; it must be a list of 2 mappings",
                          "a.yaml:2: legs[1]: is 4; it must be a mapping",
                          "a.yaml:2: legs[0].mass_kg: is missing; it must be given"));
}

// ---------------------------------------------------------------- all at once

TEST(Problems, AreAllToldInOrderOfLines) {
  const Problems problems = problems_of(
      "period_ms: -1\n"
      "mas_kg: 3\n"
      "length_kg: 4\n"
      "count: many\n",
      [](ConfigReader& reader) {
        std::chrono::nanoseconds period{};
        double value = 0.0;
        int count = 0;
        ConfigReader required = reader.required();
        required.integer("count", count);
        required.number("width", unit::m, value);
        required.number("mass", unit::kg, value);
        required.number("length", unit::m, value);
        required.duration("period", period, positive);
      });
  EXPECT_THAT(
      problems,
      ElementsAre("a.yaml:1: period_ms: is -1; it must be positive",
                  "a.yaml:1: width_m: is missing; it must be given",
                  "a.yaml:2: mas_kg: is not a known key; did you mean 'mass_kg'?",
                  "a.yaml:3: length_kg: has the wrong unit, kg; write length_m, length_mm or length_cm",
                  "a.yaml:4: count: is 'many'; it must be a whole number"));
}

TEST(ProblemsOfReaders, AreToldAtTheLineAndKeyOfTheValue) {
  EXPECT_THAT(
      problems_of("a: 1\nlegs:\n- {length_mm: 3}\n- {length_mm: 4}\n",
                  [](ConfigReader& reader) {
                    int a = 0;
                    double length = 0.0;
                    reader.integer("a", a);
                    for (ConfigReader& leg : reader.sections("legs")) leg.number("length", unit::m, length);
                    reader.problem("legs[1].length", "is too long; it must be short");
                    reader.problem("legs[0].width.depth", "does not fit; take another");
                    reader.problem("", "is strange; it must be usual");
                  }),
      ElementsAre("a.yaml:1: is strange; it must be usual", "a.yaml:3: legs[0]: does not fit; take another",
                  "a.yaml:4: legs[1].length_mm: is too long; it must be short"));
}

TEST(ProblemsOfReaders, AreNotToldOfValuesThatWereNotRead) {
  EXPECT_THAT(problems_of("mass_m: 1\nwidth_m: a\n",
                          [](ConfigReader& reader) {
                            double value = 0.0;
                            reader.required().number("mass", unit::kg, value);
                            reader.number("width", unit::m, value);
                            EXPECT_FALSE(reader.good());
                            reader.problem("mass", "is 0 kg; it must be positive");
                            reader.problem("width", "is 0 m; it must be positive");
                          }),
              ElementsAre("a.yaml:1: mass_m: has the wrong unit, m; write mass_kg or mass_g",
                          "a.yaml:2: width_m: is 'a'; it must be a number"));
}

TEST(ProblemsOfOtherFiles, AreAddedAsTheyAre) {
  EXPECT_THAT(problems_of("{}",
                          [](ConfigReader& reader) {
                            EXPECT_TRUE(reader.good());
                            reader.add_problems({"robot.yaml:3: mass_kg: is 0; it must be positive"});
                            EXPECT_FALSE(reader.good());
                          }),
              ElementsAre("robot.yaml:3: mass_kg: is 0; it must be positive"));
}

}  // namespace
}  // namespace flinch
