#include "experiments/reproduction/paper_figures.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/problems_of.h"

namespace flinch {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::SizeIs;

TEST(FiguresCalled, AreThoseWithTheWordOrSeveralInARow) {
  PaperFigures all;
  all.figures.resize(3);
  all.figures[0].id = "safepr.table4.platform";
  all.figures[1].id = "safepr.table5.platform";
  all.figures[2].id = "ral25.table4.imu";
  all.pictures.resize(1);
  all.pictures[0].id = "safepr.fig9.position";
  EXPECT_THAT(figures_called(all, "table4").figures, SizeIs(2));
  EXPECT_THAT(figures_called(all, "safepr.table4").figures, SizeIs(1));
  EXPECT_THAT(figures_called(all, "safepr").figures, SizeIs(2));
  EXPECT_THAT(figures_called(all, "safepr").pictures, SizeIs(1));
  EXPECT_THAT(figures_called(all, "fig9").figures, SizeIs(0));
  EXPECT_THAT(test::problems_of([&] { figures_called(all, "safepr.table4.platfrom"); }),
              ElementsAre(HasSubstr("did you mean 'safepr.table4.platform'?")));
}

}  // namespace
}  // namespace flinch
