#include "tests/campaign/interrupted/verb_results.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>

#include "systems/framework/monotonic_clock.h"
#include "systems/framework/recording.h"
#include "tests/support/flinch_program.h"

namespace flinch::test {
namespace {

namespace fs = std::filesystem;

/// Two texts that say the same but for some numbers, such as the time that a run took.
bool has_one_shape(const std::string& a, const std::string& b) {
  const auto longest = static_cast<long>(std::max(a.size(), b.size()));
  return std::labs(static_cast<long>(a.size()) - static_cast<long>(b.size())) <= longest / 50 &&
         a.size() > 200 && a.substr(0, 100) == b.substr(0, 100) &&
         a.substr(a.size() - 100) == b.substr(b.size() - 100);
}

/// A journal to go on from, or a file that is not finished.
bool is_leftover(const std::string& name) { return name.ends_with(".new") || name.ends_with(".part"); }

}  // namespace

VerbResults::VerbResults(fs::path folder) : folder_(std::move(folder)) { fs::create_directories(folder_); }

std::string VerbResults::scenario(const std::string& shipped, double duration) const {
  std::string text = bytes_of(place_ / ("scenarios/" + shipped));
  const std::size_t at = text.find("duration_s:");
  text.replace(at, text.find('\n', at) - at, "duration_s: " + std::to_string(duration));
  const std::string name = "scenarios/short_" + shipped;
  place_.write(name, text);
  return place_.at(name);
}

InterruptedVerb VerbResults::run() const {
  const std::string file = scenario("platform_collision.yaml", 0.6), out = folder_.string();
  return {{"run", file, "--out", out, "--quiet", "--seed", "1"},
          {"run", file, "--out", out, "--quiet", "--seed", "2"}};
}

InterruptedVerb VerbResults::campaign() const {
  scenario("platform_collision.yaml", 0.6);
  place_.write("campaigns/few.yaml",
               "scenario: ../scenarios/short_platform_collision.yaml\nruns: 6\n"
               "draw: [{key: motion.direction_deg, from: 0, to: 360}]\n");
  const auto with_seed = [&](const char* seed) -> std::vector<std::string> {
    return {"campaign", place_.at("campaigns/few.yaml"),
            "--out",    folder_.string(),
            "--quiet",  "--threads",
            "1",        "--seed",
            seed,       "--fresh"};
  };
  return {with_seed("1"), with_seed("2")};
}

InterruptedVerb VerbResults::calibrate() const {
  place_.replace("scenarios/random_motion.yaml",
                 "[momentum_observer, momentum_kalman_filter, sliding_mode_observer, "
                 "direct_extended_imu_ekf, disturbance_filter, imu_residual]\n"
                 "  detectors: [contact_detector, fused_detector]",
                 "[momentum_observer]");
  const std::string file = scenario("random_motion.yaml", 33.0);
  OtherProgram program(flinch_program({"run", file, "--out", place_.at("recorded"), "--quiet"}));
  EXPECT_EQ(program.wait(100s), 0) << program.output();
  const auto at_rate = [&](const char* rate) -> std::vector<std::string> {
    return {"calibrate", "thresholds", place_.at("recorded/run.h5"),     "--rate",
            rate,        "--out",      (folder_ / "found.yaml").string()};
  };
  return {at_rate("20"), at_rate("40")};
}

void VerbResults::make(const std::vector<std::string>& arguments) {
  const Time begin = MonotonicClock::now();
  OtherProgram program(flinch_program(arguments));
  EXPECT_EQ(program.wait(100s), 0) << program.output();
  takes_ = MonotonicClock::now() - begin;
}

void VerbResults::make_both(const InterruptedVerb& verb) {
  make(verb.newer);
  newer_ = files();
  for (const auto& [name, bytes] : newer_) fs::remove(folder_ / name);
  make(verb.older);
  older_ = files();
  if (older_.contains("run.h5")) samples_ = read_recording(folder_ / "run.h5").samples();
}

void VerbResults::make_older(const InterruptedVerb& verb) {
  make(verb.older);
  for (const auto& [name, bytes] : files()) EXPECT_TRUE(older_.contains(name)) << name << " is left over";
}

void VerbResults::expect_one_of_both() const {
  const Files now = files();
  for (const auto& [name, bytes] : older_)
    EXPECT_TRUE(now.contains(name) || is_leftover(name)) << name << " is lost";
  for (const auto& [name, bytes] : now) {
    if (!is_leftover(name)) expect_whole(name, bytes);
  }
}

void VerbResults::expect_whole(const std::string& name, const std::string& bytes) const {
  ASSERT_TRUE(older_.contains(name) && newer_.contains(name)) << name << " is none of both";
  if (name == "run.h5") {
    const Recording recording = read_recording(folder_ / name);
    EXPECT_EQ(recording.samples(), samples_);
    EXPECT_FALSE(recording.attributes.contains("recording.partial"));
  } else if (name.ends_with(".html")) {
    EXPECT_TRUE(has_one_shape(bytes, older_.at(name)) || has_one_shape(bytes, newer_.at(name))) << name;
  } else {
    EXPECT_TRUE(bytes == older_.at(name) || bytes == newer_.at(name)) << name;
  }
}

std::size_t VerbResults::leftovers() const {
  const Files now = files();
  return static_cast<std::size_t>(
      std::count_if(now.begin(), now.end(), [&](const auto& each) { return !older_.contains(each.first); }));
}

Files VerbResults::files() const {
  Files files;
  for (const auto& entry : fs::directory_iterator(folder_))
    files[entry.path().filename().string()] = bytes_of(entry.path());
  return files;
}

}  // namespace flinch::test
