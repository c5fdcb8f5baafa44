#include "experiments/scenario/key_values.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "systems/config/config_node.h"
#include "systems/config/yaml_text.h"
#include "systems/foundation/setup_error.h"
#include "tests/support/problems_of.h"

namespace flinch {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

std::vector<std::string> lines_of(const KeyValues& given) {
  std::vector<std::string> lines;
  for (const auto& value : given.values) lines.push_back(yaml_line(*value));
  return lines;
}

std::vector<std::string> values_in(const std::string& text) {
  return lines_of(parse_key_values("k=" + text));
}

std::string problem_in(const std::string& text) {
  try {
    parse_key_values("k=" + text);
  } catch (const SetupError& error) {
    return error.what();
  }
  return "";
}

TEST(KeyValuesOfACommandLine, StepThroughARangeUpToItsEnd) {
  EXPECT_THAT(values_in("20..100:20"), ElementsAre("20", "40", "60", "80", "100"));
  EXPECT_THAT(values_in("1..2:0.4"), ElementsAre("1", "1.4", "1.8"));
  EXPECT_THAT(values_in("0.1..0.5:0.1"), ElementsAre("0.1", "0.2", "0.3", "0.4", "0.5"));
  EXPECT_THAT(values_in("1..-1:-1"), ElementsAre("1", "0", "-1"));
  EXPECT_THAT(values_in("-1e-3..1e-3:1e-3"), ElementsAre("-0.001", "0", "0.001"));
  EXPECT_THAT(values_in("3..3:1"), ElementsAre("3"));
}

TEST(KeyValuesOfACommandLine, MultiplyThroughALogarithmicRange) {
  EXPECT_THAT(values_in("1..1000:*10"), ElementsAre("1", "10", "100", "1000"));
  EXPECT_THAT(values_in("8..1:*0.5"), ElementsAre("8", "4", "2", "1"));
  EXPECT_THAT(values_in("0.5..3:*2"), ElementsAre("0.5", "1", "2"));
}

TEST(KeyValuesOfACommandLine, AreListedOrInBracketsAreOne) {
  EXPECT_THAT(values_in("1,2,5"), ElementsAre("1", "2", "5"));
  EXPECT_THAT(values_in("1,10..30:10"), ElementsAre("1", "10", "20", "30"));
  EXPECT_THAT(values_in("[1,2],[3,4]"), ElementsAre("[1, 2]", "[3, 4]"));
  EXPECT_THAT(values_in("a.yaml"), ElementsAre("a.yaml"));
  EXPECT_THAT(values_in("../robots/a.yaml"), ElementsAre("../robots/a.yaml")) << "no range: a name";
}

TEST(KeyValuesOfACommandLine, SayWhatIsWrongWithARange) {
  EXPECT_THAT(problem_in("1..5"), HasSubstr("--set k=1..5: '1..5' is no range; a range is FIRST..LAST:STEP"));
  EXPECT_THAT(problem_in("1..5:x"), HasSubstr("is no range"));
  EXPECT_THAT(problem_in("1..5:0"), HasSubstr("needs a step that is not 0"));
  EXPECT_THAT(problem_in("1..5:-1"), HasSubstr("leads away from its end"));
  EXPECT_THAT(problem_in("0..5:*2"), HasSubstr("both ends must be above 0, or both below"));
  EXPECT_THAT(problem_in("1..5:*1"), HasSubstr("needs a factor above 0 that is not 1"));
  EXPECT_THAT(problem_in("1..5:*0.5"), HasSubstr("leads away from its end"));
  EXPECT_THAT(problem_in("0..1:1e-9"), HasSubstr("has more than 10000 values"));
  EXPECT_THAT(problem_in("1..inf:1"), HasSubstr("is no range"));
}

class AsAScenarioReadsThem : public ::testing::Test {
 protected:
  KeyValues read_as(const std::string& text) const { return as_read(parse_key_values(text), read); }

  std::vector<ReadValue> read = {{"control.gain", "[20, 20, 20]", "1/s", true},
                                 {"control.inertia", "0.5", "kg m^2", false},
                                 {"control.body", "[platform, link]", "", false},
                                 {"control.share", "0.5", "", false}};
};

TEST_F(AsAScenarioReadsThem, ANumberStandsForEachOfAList) {
  const KeyValues given = read_as("control.gain_per_s=20..40:20");
  EXPECT_EQ(given.key, "control.gain_per_s");
  EXPECT_THAT(lines_of(given), ElementsAre("[20, 20, 20]", "[40, 40, 40]"));
  EXPECT_THAT(lines_of(read_as("control.gain_per_s=[1,2,3]")), ElementsAre("[1, 2, 3]"));
  EXPECT_THAT(lines_of(read_as("control.gain_per_s=high")), ElementsAre("high"))
      << "for the reader to refuse";
  EXPECT_THAT(lines_of(read_as("control.body=link")), ElementsAre("link"));
  EXPECT_THAT(lines_of(read_as("control.share=3")), ElementsAre("3"));
}

TEST_F(AsAScenarioReadsThem, AKeyWithoutItsUnitIsInSI) {
  EXPECT_EQ(read_as("control.gain=3").key, "control.gain_per_s");
  EXPECT_EQ(read_as("control.inertia=3").key, "control.inertia_kg_m2");
  EXPECT_EQ(read_as("control.inertia_kg_cm2=3").key, "control.inertia_kg_cm2");
  EXPECT_EQ(read_as("control.share=3").key, "control.share");
  EXPECT_EQ(read_as("control.unknown=3").key, "control.unknown");
}

}  // namespace
}  // namespace flinch
