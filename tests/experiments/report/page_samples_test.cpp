#include "experiments/report/page_samples.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/experiments/verdict/synthetic_run.h"

namespace flinch {
namespace {

using test::SyntheticRun;

TEST(PageSamples, OfAShortRecordingAreAll) {
  const Recording run = SyntheticRun(500).touch(BodyId::from_index(0), 100, 150, 20.0).recording();
  const Recording page = page_samples(run);
  EXPECT_EQ(page.time_ns, run.time_ns);
  EXPECT_EQ(page.period, run.period);
  EXPECT_EQ(page.column("truth", "wrench_in_base", 0), run.column("truth", "wrench_in_base", 0));
}

TEST(PageSamples, OfALongRecordingAreFewAndShowItsPeak) {
  const BodyId platform = BodyId::from_index(0);
  const Recording run = SyntheticRun(25'000)
                            .touch(platform, 12'340, 12'350, 30.0)
                            .touch(platform, 12'346, 12'346, 50.0)
                            .recording();
  const Recording page = page_samples(run);
  EXPECT_EQ(samples_in_one(run), 3U);
  EXPECT_EQ(page.period, 3ms);
  ASSERT_EQ(page.samples(), 8334U);
  const std::size_t peak = 12'346 / 3;
  EXPECT_EQ(page.column("contact", "strongest.force_in_base", 0).at(peak), 50.0);
  EXPECT_EQ(page.time_ns.at(peak), 12'346'000'000);
  EXPECT_EQ(page.time_ns.at(peak + 100), 1'000'000 * static_cast<std::int64_t>(3 * (peak + 100)));
}

}  // namespace
}  // namespace flinch
