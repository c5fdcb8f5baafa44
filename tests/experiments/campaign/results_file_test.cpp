#include "experiments/campaign/results_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <cstddef>
#include <iostream>
#include <map>
#include <string>
#include <vector>

#include "experiments/campaign/campaign.h"
#include "experiments/campaign/campaign_journal.h"
#include "experiments/campaign/campaign_page.h"
#include "experiments/campaign/campaign_results.h"
#include "experiments/campaign/campaign_summary.h"
#include "experiments/campaign/counted_alarms.h"
#include "experiments/campaign/run_result.h"
#include "tests/support/file_bytes.h"
#include "tests/support/sanitized.h"
#include "tests/support/temporary_folder.h"

namespace flinch {
namespace {

RunResult contact(std::size_t run, const std::string& body) {
  RunResult result;
  result.run = result.draw = run;
  result.values = {{"pylon.radius_mm", std::to_string(15 + run % 7)}};
  result.body = body;
  result.removal_time = 0.1;
  for (const char* name : {"observer", "filter", "imu"})
    result.estimators.push_back({.name = name, .detection_time = 1e-6 * static_cast<double>(run % 5000)});
  return result;
}

TEST(TheTable, HasAColumnForWhateverAnyRunHas) {
  RunResult other = contact(1, "link, \"1\"");
  other.values = {{"gain", "[20, 20]"}};
  other.estimators.resize(1);
  other.estimators[0].name = "sliding_mode";
  const test::TemporaryFolder folder;
  write_results({contact(0, "platform"), other}, folder.path());
  const std::string table = test::bytes_of(folder / "results.csv");
  const std::string header = table.substr(0, table.find('\n'));
  EXPECT_EQ(header, csv_header(contact(0, "platform")) +
                        ",gain,sliding_mode.detection_time_s,sliding_mode.false_alarm,"
                        "sliding_mode.contact_free_s");
  const std::string rows = table.substr(header.size() + 1);
  EXPECT_EQ(rows.substr(0, rows.find('\n')), csv_row(contact(0, "platform")) + ",,,,");
  const auto cells = csv_cells(rows.substr(rows.find('\n') + 1, rows.size() - rows.find('\n') - 2));
  const auto names = csv_cells(header);
  ASSERT_EQ(cells.size(), names.size());
  std::map<std::string, std::string> row;
  for (std::size_t i = 0; i < names.size(); ++i) row[names[i]] = cells[i];
  EXPECT_EQ(row["body"], "link, \"1\"");
  EXPECT_EQ(row["gain"], "[20, 20]");
  EXPECT_EQ(row["sliding_mode.false_alarm"], "0");
  EXPECT_EQ(row["observer.false_alarm"], "");
  EXPECT_EQ(row["pylon.radius_mm"], "");
}

/// What a campaign of that many runs leaves, from its journal: tables, groups and page.
void write_all(std::size_t runs, const test::TemporaryFolder& folder) {
  Campaign campaign;
  campaign.draws = runs;
  campaign.scenarios = {"scenario.yaml"};
  campaign.scenario_texts = {"text"};
  const std::string grid_point(1000, 'g');
  CampaignJournal journal(folder.path(), campaign);
  for (std::size_t i = runs; i-- > 0;) {
    RunResult result = contact(i, i % 2 == 0 ? "platform" : "link1");
    result.values.emplace_back("control", grid_point);
    journal.add(result);
  }
  const CampaignResults results = journal.results();
  write_results(results, folder.path());
  const std::vector<CampaignGroup> groups = groups_of(campaign, results);
  write_campaign_page(campaign, results, groups, CountedAlarms(groups), "", folder / "campaign.html");
}

/// A row in the file, with the text of its point of the grid, is longer than a kilobyte.
TEST(ManyRuns, TakeAFewHundredBytesEachInMemory) {
#ifdef FLINCH_SANITIZED
  GTEST_SKIP() << "a sanitizer keeps memory for itself";
#endif
  const auto peak_in_bytes = [] {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return 1024.0 * static_cast<double>(usage.ru_maxrss);
  };
  const test::TemporaryFolder few, many;
  write_all(2'000, few);
  const double before = peak_in_bytes();
  write_all(20'000, many);
  const double each = (peak_in_bytes() - before) / 18'000.0;
  std::cout << "a run takes " << each << " bytes in memory" << std::endl;
  EXPECT_LT(each, 400.0);
  EXPECT_GT(each, 0.0) << "something else has taken more memory before";
  EXPECT_GT(test::bytes_of(many / "results.csv").size(), 20'000U * 1'000U);
}

}  // namespace
}  // namespace flinch
