// Verbs that are killed at random moments, into a folder that holds an older result. What is there afterwards
// is the older result or the new one, whole; what the dead have left goes with the next call. 20 kills of
// each verb; FLINCH_KILLS in the environment says how many instead.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <map>

#include "systems/framework/monotonic_clock.h"
#include "systems/framework/random.h"
#include "systems/framework/recording.h"
#include "tests/support/flinch_program.h"
#include "tests/support/workplace.h"

namespace flinch {
namespace {

namespace fs = std::filesystem;
using test::OtherProgram;

int wanted_kills() {
  const char* const wanted = std::getenv("FLINCH_KILLS");
  return wanted != nullptr ? std::atoi(wanted) : 20;
}

using Files = std::map<std::string, std::string>;

Files files_in(const fs::path& folder) {
  Files files;
  for (const auto& entry : fs::directory_iterator(folder))
    files[entry.path().filename().string()] = test::bytes_of(entry.path());
  return files;
}

/// Two texts that say the same but for some numbers, such as the time that a run took.
bool has_one_shape(const std::string& a, const std::string& b) {
  const auto longest = static_cast<long>(std::max(a.size(), b.size()));
  return std::labs(static_cast<long>(a.size()) - static_cast<long>(b.size())) <= longest / 50 &&
         a.size() > 200 && a.substr(0, 100) == b.substr(0, 100) &&
         a.substr(a.size() - 100) == b.substr(b.size() - 100);
}

class KilledVerbs : public testing::Test {
 protected:
  /// The arguments that make the older result, and the newer one.
  struct Verb {
    std::vector<std::string> older, newer;
  };

  std::string out() const { return place_.at("out"); }

  Files results_of(const std::vector<std::string>& arguments) {
    const Time begin = MonotonicClock::now();
    OtherProgram program(test::flinch_program(arguments));
    EXPECT_EQ(program.wait(60s), 0) << program.output();
    takes_ = MonotonicClock::now() - begin;
    return files_in(out());
  }

  /// Whether a file is that of one of the two results, from its first byte to its last.
  void expect_whole(const std::string& name, const std::string& bytes) {
    if (name == "run.h5") {
      const Recording recording = read_recording(out() + "/run.h5");
      EXPECT_EQ(recording.samples(), samples_);
      EXPECT_FALSE(recording.attributes.contains("recording.partial"));
    } else if (name.ends_with(".html")) {
      EXPECT_TRUE(has_one_shape(bytes, older_.at(name)) || has_one_shape(bytes, newer_.at(name))) << name;
    } else {
      EXPECT_TRUE(bytes == older_.at(name) || bytes == newer_.at(name)) << name;
    }
  }

  /// What a killed program may leave besides: a journal to go on from, and its own unfinished files.
  static bool is_leftover(const std::string& name) {
    return name.ends_with(".new") || name.ends_with(".part");
  }

  /// Kills the verb once. Whether it still ran.
  bool kill(const Verb& verb, RandomGenerator& random) {
    OtherProgram program(test::flinch_program(verb.newer));
    const auto moment =
        static_cast<Time::rep>(random.uniform(0.0, 1.05) * static_cast<double>(takes_.count()));
    const std::optional<int> status = program.wait(Time(moment));
    program.kill();
    EXPECT_EQ(status.value_or(0), 0) << program.output();
    const Files files = files_in(out());
    for (const auto& [name, bytes] : older_)
      EXPECT_TRUE(files.contains(name) || is_leftover(name)) << name << " is lost";
    for (const auto& [name, bytes] : files) {
      if (!is_leftover(name)) expect_whole(name, bytes);
    }
    return !status;
  }

  void kill_at_random_moments(const Verb& verb) {
    newer_ = results_of(verb.newer);
    fs::remove_all(out());
    fs::create_directories(out());
    older_ = results_of(verb.older);
    if (newer_.contains("run.h5")) samples_ = read_recording(out() + "/run.h5").samples();
    RandomGenerator random(3);
    const int kills = wanted_kills();
    int killed = 0, calls = 0, left = 0;
    while (killed < kills && calls < 3 * kills) {
      ++calls;
      killed += kill(verb, random) ? 1 : 0;
      if (calls % 5 != 0) continue;
      left += static_cast<int>(files_in(out()).size() - older_.size());
      const Files after = results_of(verb.older);
      for (const auto& [name, bytes] : after) EXPECT_TRUE(older_.contains(name)) << name << " is left over";
    }
    EXPECT_EQ(killed, kills);
    std::cout << killed << " kills within " << 1e3 * to_seconds(takes_) << " ms, " << left
              << " leftovers that the next call has removed" << std::endl;
  }

  void write_scenario(const std::string& name, const std::string& shipped, double duration) const {
    std::string text = test::bytes_of(place_ / ("scenarios/" + shipped));
    const std::size_t at = text.find("duration_s:");
    text.replace(at, text.find('\n', at) - at, "duration_s: " + std::to_string(duration));
    place_.write("scenarios/" + name, text);
  }

  test::Workplace place_;
  Files older_, newer_;
  std::size_t samples_ = 0;
  Time takes_{};
};

TEST_F(KilledVerbs, RunLeavesTheOlderRecordingOrTheNewOne) {
  write_scenario("short.yaml", "platform_collision.yaml", 0.7);
  const std::string scenario = place_.at("scenarios/short.yaml");
  kill_at_random_moments({{"run", scenario, "--out", out(), "--quiet", "--seed", "1"},
                          {"run", scenario, "--out", out(), "--quiet", "--seed", "2"}});
}

TEST_F(KilledVerbs, CampaignLeavesTheOlderTableOrTheNewOne) {
  write_scenario("short.yaml", "platform_collision.yaml", 0.45);
  place_.write(
      "campaigns/few.yaml",
      "scenario: ../scenarios/short.yaml\nruns: 6\ndraw: [{key: motion.direction_deg, from: 0, to: 360}]\n");
  const std::string campaign = place_.at("campaigns/few.yaml");
  kill_at_random_moments(
      {{"campaign", campaign, "--out", out(), "--quiet", "--threads", "1", "--seed", "1", "--fresh"},
       {"campaign", campaign, "--out", out(), "--quiet", "--threads", "1", "--seed", "2", "--fresh"}});
}

TEST_F(KilledVerbs, CalibrateLeavesTheOlderThresholdsOrTheNewOnes) {
  write_scenario("motion.yaml", "random_motion.yaml", 33.0);
  const std::string recording = place_.at("recorded/run.h5");
  OtherProgram run(test::flinch_program(
      {"run", place_.at("scenarios/motion.yaml"), "--out", place_.at("recorded"), "--quiet"}));
  ASSERT_EQ(run.wait(60s), 0) << run.output();
  fs::create_directories(out());
  const auto calibrate = [&](const char* rate) -> std::vector<std::string> {
    return {"calibrate", "thresholds", recording, "--rate", rate, "--out", out() + "/thresholds.yaml"};
  };
  kill_at_random_moments({calibrate("20"), calibrate("40")});
}

}  // namespace
}  // namespace flinch
