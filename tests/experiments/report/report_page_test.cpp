#include "experiments/report/report_page.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <nlohmann/json.hpp>
#include <random>

#include "experiments/report/report_json.h"
#include "systems/foundation/setup_error.h"
#include "tests/experiments/report/chromium.h"
#include "tests/experiments/report/sample_report.h"
#include "tests/support/problems_of.h"
#include "tests/support/temporary_folder.h"

namespace flinch {
namespace {

using nlohmann::json;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

Report small_report() {
  Report report;
  report.title = "small";
  report.period = 1e-3;
  report.columns["speed"] = {0.1, 0.2, 0.3};
  return report;
}

/// The data object as a browser finds it in the page.
json data_in(const std::string& page) {
  const std::string opening = "id=\"data\">";
  const size_t begin = page.find(opening) + opening.size();
  return json::parse(page.substr(begin, page.find("</script>", begin) - begin));
}

std::vector<std::string> problems_of(const Report& report) {
  return test::problems_of([&] { check_report(report); });
}

TEST(ReportPage, CarriesTheDataUnchangedThroughTheScriptElement) {
  EXPECT_EQ(data_in(report_page(sample_report())), json::parse(report_json(sample_report())));
}

TEST(ReportPage, IsNotEndedByTextThatLooksLikeMarkup) {
  Report report = small_report();
  report.title = "</script><script>alert(1)</script><!-- \"quoted\" \\ and \u2028";
  report.texts = {{"scenario", "<!--</SCRIPT >\n]]>"}};
  const std::string page = report_page(report);
  EXPECT_THAT(page, Not(HasSubstr("alert(1)</script>")));
  EXPECT_EQ(data_in(page)["title"], report.title);
  EXPECT_EQ(data_in(page)["texts"][0]["text"], report.texts[0].text);
}

TEST(ReportPage, ReplacesBytesThatAreNotUtf8) {
  Report report = small_report();
  report.title = "caf\xe9";
  EXPECT_EQ(data_in(report_page(report))["title"], "caf\ufffd");
}

TEST(ReportPage, RefersToNothingOutsideItself) {
  const std::string page = report_page(small_report());
  EXPECT_THAT(page, HasSubstr("default-src 'none'"));
  EXPECT_THAT(page, Not(HasSubstr("sourceMappingURL")));
  EXPECT_THAT(page, Not(HasSubstr("{{ ")));
}

TEST(ReportPage, KeepsTheLicenceNoticeOfDygraphs) {
  const std::string page = report_page(small_report());
  EXPECT_THAT(page, HasSubstr("Dan Vanderkam"));
  EXPECT_THAT(page, HasSubstr("Permission is hereby granted, free of charge"));
}

TEST(ReportPage, ThatCannotBeWrittenIsAnError) {
  EXPECT_THROW(write_report_page(small_report(), "/no/such/folder/report.html"), SetupError);
}

TEST(ReportJson, KeepsSixSignificantDigitsOfRandomNumbers) {
  std::mt19937 random(7);
  std::uniform_real_distribution<> exponent(-12.0, 12.0);
  Report report = small_report();
  std::vector<double>& values = report.columns["speed"];
  for (int i = 0; i < 1000; ++i) values.push_back((i % 2 ? -1.0 : 1.0) * std::pow(10.0, exponent(random)));
  const json column = json::parse(report_json(report))["columns"]["speed"];
  for (size_t i = 0; i < values.size(); ++i) {
    std::array<char, 32> printed{};
    std::snprintf(printed.data(), printed.size(), "%.5e", values[i]);
    EXPECT_EQ(column[i], std::strtod(printed.data(), nullptr));
  }
}

TEST(ReportJson, RoundsToNearest) {
  Report report = small_report();
  report.columns["speed"] = {0.1234564, 0.1234566, 123456789.0};
  EXPECT_EQ(json::parse(report_json(report))["columns"]["speed"].dump(), "[0.123456,0.123457,123457000.0]");
}

TEST(ReportJson, HasNullWhereThereIsNoNumber) {
  Report report = small_report();
  const double infinity = std::numeric_limits<double>::infinity();
  report.columns["speed"] = {std::nan(""), infinity, -infinity};
  report.contacts.emplace_back();
  const json data = json::parse(report_json(report));
  EXPECT_EQ(data["columns"]["speed"].dump(), "[null,null,null]");
  EXPECT_TRUE(data["contacts"][0]["detected"].is_null());
  EXPECT_TRUE(data["robot"].is_null());
}

TEST(ReportJson, KeepsOnlyTheChangesOfALane) {
  Report report;
  report.period = 1e-3;
  report.lanes = {{"mode", {"nominal", "reaction"}, {0, 0, 1, 1, -1, 0}}};
  EXPECT_EQ(json::parse(report_json(report))["lanes"][0]["changes"].dump(), "[[0,0],[2,1],[4,-1],[5,0]]");
  EXPECT_EQ(json::parse(report_json(report))["count"], 6);
}

TEST(CheckReport, AcceptsAnEmptyReportAndTheSample) {
  EXPECT_THAT(problems_of(Report()), ElementsAre());
  EXPECT_THAT(problems_of(sample_report()), ElementsAre());
}

TEST(CheckReport, NamesEveryProblemAtOnce) {
  Report report = small_report();
  report.period = 0.0;
  report.columns["sigma_capa"] = {1.0, 2.0, 3.0};
  report.columns["speed"] = {1.0};
  report.lanes = {{"mode", {"nominal"}, {0, 1, 0}}};
  report.bounds = {{"forces", "threshold", 10.0}};
  EXPECT_THAT(problems_of(report),
              ElementsAre(HasSubstr("'sigma_capa'; did you mean 'sigma_kappa'?"),
                          HasSubstr("column 'speed' has 1 samples"), HasSubstr("no name for state 1"),
                          HasSubstr("chart 'forces'"), HasSubstr("period")));
}

void expect_to_work(const Report& report) {
  const test::TemporaryFolder folder;
  write_report_page(report, folder / "page.html");
  expect_works_in_chromium(folder / "page.html");
}

TEST(ReportPage, WorksInChromium) { expect_to_work(sample_report()); }

/// As a run that a fault has stopped before anything was touched.
TEST(ReportPage, TellsInChromiumWhyARunIsNotGood) {
  Report report = small_report();
  report.good = false;
  report.fault = "no rates of the drives; 2 ticks were missed just before";
  report.reasons = {"nothing was touched, though a contact with platform was expected",
                    "the torque gate closed: " + report.fault};
  report.remarks = {"the contact with platform was not over at the end"};
  report.checks_off = {"encoders against the IMU (fault 29): needs an IMU", "two (fault 2): needs more"};
  EXPECT_EQ(json::parse(report_json(report))["checks_off"], report.checks_off);
  EXPECT_EQ(json::parse(report_json(report))["reasons"], report.reasons);
  expect_to_work(report);
}

/// As a clamping whose gate closed at last.
TEST(ReportPage, TellsInChromiumOfAClampingAndOfTheGateThatCloses) {
  Report report = small_report();
  report.contacts.emplace_back();
  report.contacts[0].body = report.contacts[0].isolated_body = "both links of leg 1 (clamping)";
  report.contacts[0].clamping_leg = "leg 1";
  report.contacts[0].several_contacts = true;
  report.contacts[0].object = "pylon";
  report.contacts[0].detected = 1e-3;
  report.contacts[0].peak_force = report.contacts[0].lasting_force.emplace(150.0);
  report.contacts[0].force_limit = 140.0;
  report.contacts[0].over_limit = 0.02;
  report.fault = "the encoders are silent";
  report.lanes = {{"limits", {"not kept", "kept", "rotation, more than the drives have"}, {1, 2, 0}},
                  {"torque gate", {"waiting", "open", "closed"}, {1, 1, 2}}};
  expect_to_work(report);
}

TEST(ReportPage, WorksInChromiumWithTheLeastOfData) {
  expect_to_work(small_report());
  expect_to_work(Report());
}

}  // namespace
}  // namespace flinch
