// flinch campaign under mpirun.
#include "experiments/ranks/campaign_ranks.h"

#include <gtest/gtest.h>
#include <signal.h>

#include <algorithm>
#include <fstream>
#include <thread>

#include "experiments/campaign/campaign.h"
#include "experiments/campaign/run_campaign.h"
#include "tests/support/other_program.h"
#include "tests/support/workplace.h"

namespace flinch {
namespace {

/// The program that has both texts in a file of /proc of its own; none: 0.
pid_t program_with(const std::string& argument, const std::string& variable) {
  for (const auto& entry : std::filesystem::directory_iterator("/proc")) {
    const std::string name = entry.path().filename().string();
    if (name.find_first_not_of("0123456789") != std::string::npos) continue;
    const auto holds = [&](const char* file, const std::string& text) {
      return test::bytes_of(entry.path() / file).find(text) != std::string::npos;
    };
    if (holds("cmdline", argument) && holds("environ", variable)) return std::stoi(name);
  }
  return 0;
}

class RanksOfACampaign : public ::testing::Test {
 protected:
  void SetUp() override {
    place.replace("scenarios/platform_collision.yaml", "duration_s: 1.2", "duration_s: 0.6");
    write_campaign(8);
  }

  void write_campaign(int draws) const {
    place.write("campaigns/few.yaml",
                "scenario: ../scenarios/platform_collision.yaml\n"
                "runs: " +
                    std::to_string(draws) +
                    "\n"
                    "contact: {body: [platform, link2]}\n"
                    "draw: [{key: motion.direction_deg, from: 0, to: 360}]\n");
  }

  test::OtherProgram::Start mpirun(int ranks, const std::vector<std::string>& more = {}) const {
    test::OtherProgram::Start start;
    start.command = {MPIEXEC,
                     "--oversubscribe",
                     "-n",
                     std::to_string(ranks),
                     FLINCH_PROGRAM,
                     "campaign",
                     place.at("campaigns/few.yaml"),
                     "--out",
                     place.at("out"),
                     "--quiet"};
    start.command.insert(start.command.end(), more.begin(), more.end());
    start.environment = {
        {"OMPI_ALLOW_RUN_AS_ROOT", "1"},
        {"OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1"},
        {"OMPI_MCA_mpi_yield_when_idle", "1"}};  // ranks that wait leave a busy machine alone
    return start;
  }

  std::size_t rows() const {
    const std::string journal = test::bytes_of(place / "out/results.part");
    return static_cast<std::size_t>(std::count(journal.begin(), journal.end(), '\n'));
  }

  /// Kills rank 2 once there are so many rows; returns whether there was one.
  bool lose_a_rank(test::OtherProgram& program, std::size_t least_rows) const {
    while (program.is_running() && rows() < least_rows) std::this_thread::sleep_for(1ms);
    const pid_t rank = program_with(place.at("campaigns/few.yaml"), "OMPI_COMM_WORLD_RANK=2");
    return rank > 0 && kill(rank, SIGKILL) == 0;
  }

  /// The job that ships, as Slurm starts it with three processors.
  test::OtherProgram::Start job(const std::vector<std::string>& more = {}) const {
    test::OtherProgram::Start start = mpirun(3, more);
    start.command.erase(start.command.begin(), start.command.begin() + 6);  // up to "campaign"
    start.command.insert(start.command.begin(),
                         {"/bin/sh", FLINCH_SOURCE_DIR "/apps/campaigns/campaign_job.sh"});
    start.environment["SLURM_NTASKS"] = "3";
    start.environment["FLINCH"] = FLINCH_PROGRAM;
    start.environment["OMPI_MCA_rmaps_base_oversubscribe"] = "1";
    return start;
  }

  void expect_the_table_of_one_thread() const {
    std::filesystem::create_directories(place / "alone");
    run_campaign(read_campaign(place / "campaigns/few.yaml"), place / "alone", 1);
    for (const std::string name : {"results.csv", "results.h5"}) {
      const std::string alone = test::bytes_of(place / ("alone/" + name));
      EXPECT_FALSE(alone.empty());
      EXPECT_TRUE(test::bytes_of(place / ("out/" + name)) == alone) << name;
    }
  }

  test::Workplace place;
};

TEST_F(RanksOfACampaign, GiveTheTableOfOneThread) {
  for (const int ranks : {2, 4}) {
    test::OtherProgram program(mpirun(ranks, {"--fresh"}));
    EXPECT_EQ(program.wait(300s), 0) << program.output();
    expect_the_table_of_one_thread();
  }
}

TEST_F(RanksOfACampaign, AreResumedWhereOneWasLost) {
  write_campaign(150);
  {
    test::OtherProgram program(mpirun(3));
    ASSERT_TRUE(lose_a_rank(program, 10)) << program.output();
    const std::optional<int> status = program.wait(60s);
    ASSERT_TRUE(status.has_value()) << "it still runs";
    EXPECT_NE(*status, 0);
  }
  const std::size_t done = rows();
  EXPECT_LT(done, 302U) << "it was lost on the way";
  test::OtherProgram program(mpirun(2));
  EXPECT_EQ(program.wait(300s), 0) << program.output();
  expect_the_table_of_one_thread();
}

TEST_F(RanksOfACampaign, AreCalledAgainByTheirJobWhereOneWasLost) {
  write_campaign(150);
  test::OtherProgram program(job({"--fresh"}));
  ASSERT_TRUE(lose_a_rank(program, 10)) << program.output();
  EXPECT_EQ(program.wait(300s), 0) << program.output();
  EXPECT_NE(program.output().find("call 2 of 5 does the runs that are left"), std::string::npos);
  EXPECT_EQ(program.output().find("call 3 of 5"), std::string::npos);
  expect_the_table_of_one_thread();
}

TEST_F(RanksOfACampaign, AreNotCalledAgainByTheirJobForWhatIsWrong) {
  test::OtherProgram program(job({"--set", "control.contact_detector.reacton_force_N=8"}));
  EXPECT_EQ(program.wait(60s), 2) << program.output();
  EXPECT_EQ(program.output().find("does the runs that are left"), std::string::npos);
}

TEST_F(RanksOfACampaign, SayWhatIsWrongOnceAndEnd) {
  test::OtherProgram program(mpirun(3, {"--set", "control.contact_detector.reacton_force_N=8"}));
  const std::optional<int> status = program.wait(60s);
  ASSERT_TRUE(status.has_value()) << "it still runs";
  EXPECT_NE(*status, 0);
  const std::string said = program.output();
  const std::string problem = "did you mean 'reaction_force_N'?";
  const std::size_t first = said.find(problem);
  ASSERT_NE(first, std::string::npos) << said;
  EXPECT_EQ(said.find(problem, first + 1), std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(place / "out"));
}

}  // namespace
}  // namespace flinch
