#include "apps/flinch/today.h"

#include <gtest/gtest.h>

#include <regex>

namespace flinch {
namespace {

TEST(MomentInNames, BeginsWithTheDateAndHasNothingThatAFolderMayNot) {
  const std::string moment = moment_in_names();
  EXPECT_TRUE(std::regex_match(moment, std::regex("\\d{4}-\\d{2}-\\d{2}_\\d{2}-\\d{2}-\\d{2}"))) << moment;
  EXPECT_LE(moment.substr(0, 10), today());
}

TEST(MomentInNames, IsLaterByNamesWhereItIsLater) {
  const std::string before = moment_in_names();
  EXPECT_LE(before, moment_in_names());
}

}  // namespace
}  // namespace flinch
