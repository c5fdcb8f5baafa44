// Journals of campaigns: rows of their table. Their checksums are made good before they are read.
#include "experiments/campaign/campaign_journal.h"

#include <cstdint>
#include <cstdio>
#include <sstream>

#include "experiments/campaign/campaign.h"
#include "tests/fuzz/fuzz_files.h"
#include "tests/fuzz/fuzz_target.h"
#include "tests/support/file_bytes.h"

namespace flinch::test {
namespace {

Campaign hundred_runs() {
  Campaign campaign;
  campaign.draws = 100;
  campaign.scenarios = {"scenario.yaml"};
  campaign.scenario_texts = {"text"};
  campaign.robot_texts = {"text"};
  return campaign;
}

RunResult example(std::size_t run) {
  RunResult result;
  result.run = run;
  result.draw = run;
  result.seed = 7;
  result.values = {{"motion.speed_m_per_s", "0.5"}, {"contact", "\"a, b\""}};
  result.good = true;
  result.removal_time = 0.12;
  result.estimators = {{.name = "momentum_observer", .detection_time = 0.005}, {.name = "imu_residual"}};
  return result;
}

/// A row with its checksum: FNV-1a of its bytes.
std::string sealed_row(const std::string& row) {
  std::uint64_t hash = 0xcbf29ce484222325U;
  for (const char c : row) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3U;
  char text[32];
  std::snprintf(text, sizeof text, ",%016llx\n", static_cast<unsigned long long>(hash));
  return row + text;
}

/// The first line of a journal of that campaign.
std::string first_line(const Campaign& campaign) {
  const std::filesystem::path folder = fuzz_folder() / "empty_campaign";
  std::filesystem::create_directories(folder);
  { const CampaignJournal journal(folder, campaign); }
  const std::string text = bytes_of(folder / "results.part");
  return text.substr(0, text.find('\n') + 1);
}

void try_campaign_journal(std::string_view bytes) {
  static const Campaign campaign = hundred_runs();
  static const std::string first = first_line(campaign);
  static const std::filesystem::path folder = fuzz_folder() / "campaign";
  std::filesystem::create_directories(folder);
  std::string journal = first;
  std::istringstream rows{std::string(bytes)};
  for (std::string row; std::getline(rows, row);) journal += sealed_row(row);
  fuzz_file("campaign/results.part", journal);
  CampaignJournal(folder, campaign).results();
}

std::vector<std::string> campaign_journal_seeds() {
  return {csv_header(example(0)) + "\n" + csv_row(example(3)) + "\n" + csv_row(example(7)) + "\n"};
}

}  // namespace

const FuzzTarget campaign_journal_target{"campaign_journal", try_campaign_journal, campaign_journal_seeds};

}  // namespace flinch::test
