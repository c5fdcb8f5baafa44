#include "experiments/campaign/campaign_journal.h"

#include <fmt/core.h>

#include <algorithm>

#include "experiments/campaign/campaign.h"
#include "systems/foundation/fnv1a.h"
#include "systems/foundation/result_file.h"
#include "systems/foundation/setup_error.h"

namespace flinch {
namespace {

const std::string first_column = "run,";  // with which headers begin

std::string sealed(const std::string& row) { return fmt::format("{},{:016x}\n", row, fnv1a(row)); }

/// The row that was sealed; "" where the line is torn.
std::string unsealed(const std::string& line) {
  const std::size_t comma = line.rfind(',');
  if (comma == std::string::npos) return "";
  std::string row = line.substr(0, comma);
  return line + "\n" == sealed(row) ? row : "";
}

std::string first_line(const Campaign& campaign) {
  return fmt::format("flinch campaign {:016x}", fnv1a(campaign.identity()));
}

}  // namespace

CampaignJournal::CampaignJournal(const std::filesystem::path& folder, const Campaign& campaign)
    : file_(folder / "results.part"), first_line_(first_line(campaign)), is_done_(campaign.runs()) {
  std::ifstream before = rows();
  // Written anew, so that what follows does not stand behind half a row.
  const std::filesystem::path anew = file_.string() + ".new";
  remove_link(anew);
  stream_.open(anew, std::ios::binary);
  stream_ << first_line_ << "\n";
  read(std::move(before), [&](RunResult&& result) { add(result); });
  std::error_code error;
  std::filesystem::rename(anew, file_, error);
  if (!stream_.flush() || error) throw SetupError(file_.string() + ": the file cannot be written");
}

std::ifstream CampaignJournal::rows() const {
  std::ifstream stream(file_, std::ios::binary);
  std::string line;
  if (stream && std::getline(stream, line) && line != first_line_) {
    throw SetupError(
        file_.string() +
        ": holds the results of another campaign, or of other scenarios, seeds or versions; choose "
        "another folder with --out, or begin anew with --fresh");
  }
  return stream;
}

void CampaignJournal::read(std::ifstream rows, const std::function<void(RunResult&&)>& take) const {
  std::vector<std::string> names;
  std::string line;
  while (std::getline(rows, line)) {
    const std::string row = unsealed(line);
    if (row.starts_with(first_column)) {
      names = csv_cells(row);
      continue;
    }
    auto result = parse_csv_row(names, row);
    if (result && result->run < is_done_.size()) take(std::move(*result));
  }
}

std::vector<RunResult> CampaignJournal::results() const {
  std::vector<RunResult> results;
  results.reserve(done_);
  read(rows(), [&](RunResult&& result) { results.push_back(std::move(result)); });
  if (results.size() != done_) throw SetupError(file_.string() + ": what was written there cannot be read");
  std::sort(results.begin(), results.end(),
            [](const RunResult& a, const RunResult& b) { return a.run < b.run; });
  return results;
}

std::string CampaignJournal::lines_of(const RunResult& result) {
  std::string header = csv_header(result);
  const bool is_another = header != header_;
  header_ = std::move(header);
  return (is_another ? sealed(header_) : "") + sealed(csv_row(result));
}

void CampaignJournal::add(const RunResult& result) {
  if (is_done_[result.run]) return;
  stream_ << lines_of(result);
  if (!stream_.flush()) {
    throw SetupError(file_.string() +
                     ": the disk takes no more; what is done is kept, go on with the same call");
  }
  is_done_[result.run] = true;
  ++done_;
}

}  // namespace flinch
