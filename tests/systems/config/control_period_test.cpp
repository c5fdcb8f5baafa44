#include "systems/config/control_period.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/systems/config/problems_of.h"

namespace flinch {
namespace {

using namespace std::chrono_literals;
using test::problems_of;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

std::chrono::nanoseconds period_in(const std::string& text) {
  std::chrono::nanoseconds period = default_control_period;
  ConfigReader reader = ConfigReader::parse(text, "a.yaml");
  read_control_period(reader, period);
  reader.finish();
  return period;
}

TEST(ControlPeriod, IsAMillisecondWhereNothingIsSaid) {
  ConfigReader reader = ConfigReader::parse("name: a", "a.yaml");
  std::chrono::nanoseconds period = default_control_period;
  std::string name;
  reader.text("name", name);
  read_control_period(reader, period);
  reader.finish();
  EXPECT_EQ(period, 1ms);
}

TEST(ControlPeriod, IsReadInAnyUnitWithBothBounds) {
  EXPECT_EQ(period_in("control_period_us: 250"), 250us);
  EXPECT_EQ(period_in("control_period_us: 4000"), 4ms);
  EXPECT_EQ(period_in("control_period_ms: 2"), 2ms);
}

TEST(ControlPeriod, OutsideOfItsBoundsIsRefusedWithFileLineKeyValueAndRange) {
  for (const char* const text :
       {"control_period_us: 100", "control_period_us: 5000", "control_period_us: 0"}) {
    const auto found = problems_of(std::string("\n") + text, [](ConfigReader& reader) {
      std::chrono::nanoseconds period = default_control_period;
      read_control_period(reader, period);
    });
    EXPECT_THAT(found, ElementsAre(::testing::AllOf(HasSubstr("a.yaml:2: control_period_us: is "),
                                                    HasSubstr("must lie between 250 and 4000"))));
  }
}

}  // namespace
}  // namespace flinch
