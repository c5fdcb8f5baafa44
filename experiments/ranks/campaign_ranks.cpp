#include "experiments/ranks/campaign_ranks.h"

#include <mpi.h>

#include <cstdint>
#include <functional>

#include "experiments/campaign/campaign.h"
#include "experiments/campaign/run_campaign.h"
#include "systems/foundation/setup_error.h"

namespace flinch {
namespace {

// What is said: a question for a run, its answer, a row of the table with its header, problems.
enum Tag { question, run_number, table_row, complaint };

constexpr int in_store = 2;  // questions of a rank that are not answered yet
constexpr std::int64_t nothing_left = -1;

void send(const std::string& text, int to, Tag tag) {
  MPI_Send(text.data(), static_cast<int>(text.size()), MPI_CHAR, to, tag, MPI_COMM_WORLD);
}

/// The message that `status` tells of.
std::string receive(const MPI_Status& status) {
  int size = 0;
  MPI_Get_count(&status, MPI_CHAR, &size);
  std::string text(static_cast<std::size_t>(size), '\0');
  MPI_Recv(text.data(), size, MPI_CHAR, status.MPI_SOURCE, status.MPI_TAG, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
  return text;
}

std::string joined(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += (text.empty() ? "" : "\n") + line;
  return text;
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines(1);
  for (const char c : text) {
    if (c == '\n') {
      lines.emplace_back();
    } else {
      lines.back() += c;
    }
  }
  return lines;
}

/// Whether all ranks have read the same as rank 0.
bool is_same_everywhere(const std::string& text) {
  std::uint64_t first = std::hash<std::string>{}(text);
  const std::uint64_t own = first;
  MPI_Bcast(&first, 1, MPI_UINT64_T, 0, MPI_COMM_WORLD);
  int same = own == first ? 1 : 0, all_same = 0;
  MPI_Allreduce(&same, &all_same, 1, MPI_INT, MPI_MIN, MPI_COMM_WORLD);
  return all_same == 1;
}

}  // namespace

CampaignRanks::CampaignRanks(const Campaign& campaign) {
  int provided = 0, count = 1;
  MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &provided);
  MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
  MPI_Comm_size(MPI_COMM_WORLD, &count);
  if (!is_same_everywhere(campaign.identity())) {
    MPI_Finalize();
    throw SetupError(
        campaign.file.string() +
        ": is not the same for all ranks, or a scenario or robot file, or the version of flinch");
  }
  asking_.assign(static_cast<std::size_t>(count), in_store);
}

CampaignRanks::~CampaignRanks() {
  if (leads()) {
    for (std::size_t rank = 1; rank < asking_.size(); ++rank) {
      while (asking_[rank] > 0) answer([] { return std::nullopt; }, [](const RunResult&) {});
    }
  }
  MPI_Finalize();
}

void CampaignRanks::work(const Campaign& campaign) {
  for (int i = 0; i < in_store; ++i) send("", 0, question);
  for (int waiting = in_store; waiting > 0;) {
    std::int64_t number = nothing_left;
    MPI_Recv(&number, 1, MPI_INT64_T, 0, run_number, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
    if (number == nothing_left) {
      --waiting;
      continue;
    }
    try {
      const RunResult result = do_run(campaign, static_cast<std::size_t>(number));
      send(csv_header(result) + "\n" + csv_row(result), 0, table_row);
    } catch (const SetupError& error) {
      send(joined(error.problems()), 0, complaint);
    }
    send("", 0, question);
  }
}

void CampaignRanks::serve(const NextRun& next, const TakeResult& take) {
  for (;;) {
    int is_there = 0;
    MPI_Iprobe(MPI_ANY_SOURCE, MPI_ANY_TAG, MPI_COMM_WORLD, &is_there, MPI_STATUS_IGNORE);
    if (is_there == 0) return;
    answer(next, take);
  }
}

/// Waits for a message of any rank and does what it asks for.
void CampaignRanks::answer(const NextRun& next, const TakeResult& take) {
  MPI_Status status;
  MPI_Probe(MPI_ANY_SOURCE, MPI_ANY_TAG, MPI_COMM_WORLD, &status);
  const std::string text = receive(status);
  if (status.MPI_TAG == complaint) throw SetupError(lines_of(text));
  if (status.MPI_TAG == table_row) {
    const std::vector<std::string> lines = lines_of(text);
    const auto result = parse_csv_row(csv_cells(lines.front()), lines.back());
    if (!result) throw SetupError("rank " + std::to_string(status.MPI_SOURCE) + " sent a row that is none");
    return take(*result);
  }
  const std::optional<std::size_t> run = next();
  const std::int64_t number = run ? static_cast<std::int64_t>(*run) : nothing_left;
  if (!run) --asking_[static_cast<std::size_t>(status.MPI_SOURCE)];
  MPI_Send(&number, 1, MPI_INT64_T, status.MPI_SOURCE, run_number, MPI_COMM_WORLD);
}

}  // namespace flinch
