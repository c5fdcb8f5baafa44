#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "systems/foundation/html_page.h"
#include "tests/apps/flinch/program.h"
#include "tests/support/workplace.h"

namespace flinch::test {

/// Something wrong that the program is given, with older results in the way.
class BadInput : public ::testing::Test {
 public:
  static constexpr const char* collision = "scenarios/platform_collision.yaml";

 protected:
  void SetUp() override {
    place.write("out/run.h5", "an older recording");
    place.write("out/report.html", page_head("an older report", ""));
  }

  /// Runs the program, which must leave every file as it is, and print nothing but one line on stderr.
  std::string complaint(const std::vector<std::string>& arguments) {
    const auto before = place.contents();
    const Outcome outcome = flinch(arguments);
    EXPECT_EQ(outcome.status, 2);
    EXPECT_EQ(outcome.out, "");
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
    EXPECT_TRUE(place.contents() == before) << "files were written";
    return outcome.err;
  }

  /// The same for 'flinch run' with the older results in the way.
  std::string complaint_of_run(const std::string& scenario = collision) {
    return complaint({"run", place.at(scenario), "--out", place.at("out")});
  }

  /// "error: FILE:LINE: ", where LINE is the one with `text`.
  std::string at_line_of(const std::string& name, const std::string& text) const {
    return "error: " + place.at(name) + ":" + std::to_string(place.line_of(name, text)) + ": ";
  }

  test::Workplace place;
};

}  // namespace flinch::test
