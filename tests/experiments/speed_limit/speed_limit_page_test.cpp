#include "experiments/speed_limit/speed_limit_page.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "systems/robot/parallel_robot.h"
#include "tests/experiments/report/chromium.h"
#include "tests/experiments/speed_limit/sample_limits.h"

namespace flinch {
namespace {

using nlohmann::json;

class SpeedLimitPage : public ::testing::Test, protected test::SampleLimits {
 protected:
  std::string page() const {
    return speed_limit_page(
        study, limits, [](const SpeedLimit& limit) { return "flinch run " + limit.cell.body; }, "the call");
  }
  json data() const {
    const std::string text = page(), begin = "<script type=\"application/json\" id=\"data\">";
    const std::size_t first = text.find(begin) + begin.size();
    return json::parse(text.substr(first, text.find("</script>", first) - first));
  }
};

TEST_F(SpeedLimitPage, HasEveryCellAndTheRobotWhereTheScenarioPutsIt) {
  EXPECT_EQ(page().find("{{ "), std::string::npos);
  const json shown = data();
  ASSERT_EQ(shown["cells"].size(), 8U);
  EXPECT_EQ(shown["cells"][1]["speed"], 0.434);
  EXPECT_EQ(shown["cells"][1]["call"], "flinch run link1");
  EXPECT_TRUE(shown["cells"][5]["bound"].is_null());
  EXPECT_EQ(shown["cells"][5]["reason"], "the legs do not reach the pose");
  Kinematics there;
  study.robot->kinematics(study.pose, PlatformVector::Zero(3), there);
  for (std::size_t leg = 0; leg < 3; ++leg) {
    EXPECT_EQ(shown["robot"]["legs"][leg][1][0], there.legs[leg].passive_joint[0]);
    EXPECT_EQ(shown["robot"]["legs"][leg][2][1], there.legs[leg].coupling_joint[1]);
  }
}

TEST_F(SpeedLimitPage, ShowsTheMap) {
  const test::Workplace place;
  place.write("speed_limit.html", page());
  expect_works_in_chromium(place / "speed_limit.html", "speed_limit/map_in_browser.py");
}

}  // namespace
}  // namespace flinch
