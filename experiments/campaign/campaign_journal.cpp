#include "experiments/campaign/campaign_journal.h"

#include <fmt/core.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <utility>

#include "experiments/campaign/campaign.h"
#include "systems/foundation/fnv1a.h"
#include "systems/foundation/journal_file.h"
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

SetupError cannot_be_read(const std::filesystem::path& file) {
  return SetupError(file.string() + ": what was written there cannot be read");
}

constexpr const char* journal_name = "results.part";

/// The rows of the journal `file`; at their end where there is none. Throws SetupError, with the way out,
/// where it does not begin with `first_line`.
std::ifstream rows_of(const std::filesystem::path& file, const std::string& first_line,
                      const std::string& way_out) {
  std::ifstream stream(file, std::ios::binary);
  std::string line;
  if (stream && std::getline(stream, line) && line != first_line) {
    throw SetupError(file.string() +
                     ": holds the results of another campaign, or of other scenarios, options, seeds or "
                     "versions; " +
                     way_out);
  }
  return stream;
}

/// Where the rows of a journal stand.
class WrittenRows {
 public:
  WrittenRows(std::filesystem::path file, std::size_t rows)
      : file_(std::move(file)), stream_(file_, std::ios::binary) {
    rows_.reserve(rows);
  }

  std::size_t size() const { return rows_.size(); }
  void add(std::size_t run, const std::vector<std::string>& names, std::streamoff at) {
    auto header = std::find(headers_.begin(), headers_.end(), names);
    if (header == headers_.end()) header = headers_.insert(header, names);
    rows_.push_back({run, static_cast<std::size_t>(header - headers_.begin()), at});
  }
  void sort() {
    std::sort(rows_.begin(), rows_.end(), [](const Row& a, const Row& b) { return a.run < b.run; });
  }

  RunResult read(std::size_t place) {
    const Row& row = rows_[place];
    std::string line;
    std::getline(stream_.seekg(row.at), line);
    std::optional<RunResult> result = parse_csv_row(headers_[row.header], unsealed(line));
    if (!result || result->run != row.run) throw cannot_be_read(file_);
    return std::move(*result);
  }

 private:
  struct Row {
    std::size_t run;
    std::size_t header;
    std::streamoff at;
  };

  std::filesystem::path file_;
  std::ifstream stream_;
  std::vector<std::vector<std::string>> headers_;
  std::vector<Row> rows_;
};

}  // namespace

void require_no_other_results(const std::filesystem::path& folder, const Campaign& campaign) {
  rows_of(folder / journal_name, first_line(campaign),
          "its runs have other numbers or values; give the options that it was made with, or another folder "
          "with --out");
}

CampaignJournal::CampaignJournal(const std::filesystem::path& folder, const Campaign& campaign)
    : file_(folder / journal_name),
      way_out_(campaign.of_single_runs ? "choose another folder with --out, or remove that file"
                                       : "choose another folder with --out, or begin anew with --fresh"),
      first_line_(first_line(campaign)),
      is_done_(campaign.runs()) {
  std::ifstream before = rows();
  // Written anew, so that what follows does not stand behind half a row.
  begin_journal(file_, stream_, [&] {
    stream_ << first_line_ << "\n";
    read(std::move(before), [&](const RunResult& result, const auto&, std::streamoff) { add(result); });
  });
}

std::ifstream CampaignJournal::rows() const { return rows_of(file_, first_line_, way_out_); }

void CampaignJournal::read(std::ifstream rows, const TakeRow& take) const {
  std::vector<std::string> names;
  std::string line;
  for (std::streamoff at = rows.tellg(); std::getline(rows, line); at = rows.tellg()) {
    const std::string row = unsealed(line);
    if (row.starts_with(first_column)) {
      names = csv_cells(row);
      continue;
    }
    const auto result = parse_csv_row(names, row);
    if (result && result->run < is_done_.size()) take(*result, names, at);
  }
}

CampaignResults CampaignJournal::results() const {
  auto written = std::make_shared<WrittenRows>(file_, done_);
  read(rows(), [&](const RunResult& result, const std::vector<std::string>& names, std::streamoff at) {
    written->add(result.run, names, at);
  });
  if (written->size() != done_) throw cannot_be_read(file_);
  written->sort();
  return {written->size(), [written](std::size_t place) { return written->read(place); }};
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
