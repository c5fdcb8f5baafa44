#include "calibration/calibration_sources.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "systems/foundation/sha256.h"
#include "tests/support/problems_of.h"
#include "tests/support/temporary_folder.h"

namespace flinch {
namespace {

TEST(Sources, AreEachOfOtherBytes) {
  const CalibrationSource a{"a/run.h5", "01"}, b{"b/run.h5", "02"}, copy{"copy/run.h5", "01"};
  EXPECT_NO_THROW(require_different({}));
  EXPECT_NO_THROW(require_different({a, b}));
  EXPECT_THAT(test::problems_of([&] {
                require_different({a, b, copy, a});
              }),
              testing::ElementsAre("copy/run.h5: holds the same as a/run.h5; leave one of them out",
                                   "a/run.h5: holds the same as a/run.h5; leave one of them out"));
}

TEST(ASource, IsKnownByTheBytesOfTheRecordingOrOfWhatAKilledRunLeft) {
  const test::TemporaryFolder place;
  const std::filesystem::path whole = place.write("whole.h5", "bytes");
  place.write("killed.h5.part", "bytes");
  EXPECT_EQ(source_of(whole).sha256, sha256("bytes"));
  EXPECT_EQ(source_of(place / "killed.h5").sha256, sha256("bytes"));
  EXPECT_EQ(source_of(place / "killed.h5").file, (place / "killed.h5").string());
}

}  // namespace
}  // namespace flinch
