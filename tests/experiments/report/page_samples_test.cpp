#include "experiments/report/page_samples.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace flinch {
namespace {

using testing::ElementsAre;

TEST(PageSamples, AreAllOfAShortRecordingAndFewOfALongOne) {
  EXPECT_EQ(samples_in_one(0), 1U);
  EXPECT_EQ(samples_in_one(most_page_samples), 1U);
  EXPECT_EQ(samples_in_one(most_page_samples + 1), 2U);
  EXPECT_EQ(samples_in_one(3'600'000), 360U);
}

TEST(PageSamples, ShowThePeakOfEachColumnByItself) {
  PageSamples page(3);
  const std::size_t x = page.column("x"), y = page.column("y"), speed = page.column("speed");
  const std::size_t state = page.lane("detector", {"quiet", "contact"});
  const double values[] = {1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0};
  const double hardness[] = {0.0, 5.0, 1.0, 0.0, 0.0, 0.0, 0.0};
  const double speeds[] = {0.1, 0.2, -0.9, 0.3, -0.1, 0.2, 0.4};
  for (std::size_t k = 0; k < 7; ++k) {
    page.begin();
    page.set(x, values[k], hardness[k]);
    page.set(y, -values[k], hardness[k]);
    page.set(speed, speeds[k]);
    page.set_state(state, k == 4 ? 1 : 0, k == 4 ? 1.0 : 0.0);
  }
  Report report;
  page.finish(report);
  EXPECT_THAT(report.columns.at("x"), ElementsAre(2.0, 4.0, 7.0));  // the hardest, else the first
  EXPECT_THAT(report.columns.at("y"), ElementsAre(-2.0, -4.0, -7.0));
  EXPECT_THAT(report.columns.at("speed"), ElementsAre(-0.9, 0.3, 0.4));
  ASSERT_EQ(report.lanes.size(), 1U);
  EXPECT_THAT(report.lanes[0].state, ElementsAre(0, 1, 0));
}

TEST(PageSamples, ShowNoDataOnlyWhereThereIsNoneInAllTogether) {
  PageSamples page(2);
  const std::size_t column = page.column("speed");
  for (const double value : {std::nan(""), 0.5, 0.0, std::nan(""), std::nan(""), std::nan("")}) {
    page.begin();
    page.set(column, value);
  }
  Report report;
  page.finish(report);
  const std::vector<double>& shown = report.columns.at("speed");
  ASSERT_EQ(shown.size(), 3U);
  EXPECT_EQ(shown[0], 0.5);
  EXPECT_EQ(shown[1], 0.0);
  EXPECT_TRUE(std::isnan(shown[2]));
}

}  // namespace
}  // namespace flinch
