// A campaign that is killed again and again, and resumed: its table is that of one that nobody disturbed.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <thread>

#include "systems/framework/random.h"
#include "tests/apps/flinch/program.h"
#include "tests/support/other_program.h"
#include "tests/support/workplace.h"

namespace flinch {
namespace {

class KilledCampaign : public ::testing::Test {
 protected:
  void SetUp() override {
    place.replace("scenarios/platform_collision.yaml", "duration_s: 1.2", "duration_s: 0.45");
    place.write("campaigns/many.yaml",
                "scenario: ../scenarios/platform_collision.yaml\n"
                "runs: 120\n"
                "contact: {body: [platform, link2]}\n"
                "draw: [{key: motion.direction_deg, from: 0, to: 360}]\n");
  }

  std::vector<std::string> command(const std::string& out) const {
    return {"campaign", place.at("campaigns/many.yaml"), "--out", place.at(out), "--threads", "2", "--quiet"};
  }
  std::size_t rows() const {
    const std::string journal = test::bytes_of(place / "killed/results.part");
    return static_cast<std::size_t>(std::count(journal.begin(), journal.end(), '\n'));
  }

  /// Lets the campaign add some rows, then kills it a moment later. Returns whether it was killed.
  bool kill_after(std::size_t more_rows, std::chrono::microseconds moment) const {
    const std::size_t before = rows();
    test::OtherProgram campaign([this] { test::flinch(command("killed")); });
    while (campaign.is_running() && rows() < before + more_rows) std::this_thread::sleep_for(100us);
    std::this_thread::sleep_for(moment);
    const bool is_killed = campaign.is_running();
    campaign.kill();
    while (campaign.is_running()) std::this_thread::sleep_for(100us);
    return is_killed;
  }

  test::Workplace place;
};

TEST_F(KilledCampaign, GivesTheSameTableAfterTwentyKills) {
  RandomGenerator random(7);
  int kills = 0;
  for (int call = 0; call < 20; ++call)
    kills += kill_after(1 + random() % 4, std::chrono::microseconds(random() % 3000)) ? 1 : 0;
  EXPECT_EQ(kills, 20);
  EXPECT_FALSE(std::filesystem::exists(place / "killed/results.csv"))
      << "no table is better than a part of one";
  EXPECT_EQ(test::flinch(command("killed")).status, 0);
  EXPECT_EQ(test::flinch(command("undisturbed")).status, 0);
  for (const std::string name : {"results.csv", "results.h5"}) {
    const std::string whole = test::bytes_of(place / ("undisturbed/" + name));
    EXPECT_FALSE(whole.empty());
    EXPECT_TRUE(test::bytes_of(place / ("killed/" + name)) == whole) << name;
  }
}

}  // namespace
}  // namespace flinch
