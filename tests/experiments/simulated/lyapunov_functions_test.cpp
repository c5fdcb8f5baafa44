// The Lyapunov functions of what laws on the torque level serve, [SafePR] (47) and Fig. 15, in recorded runs.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "experiments/simulated/experiment.h"
#include "experiments/simulated/simulated_scenario.h"
#include "experiments/verdict/recorded_truth.h"
#include "systems/config/config_file.h"
#include "systems/framework/recorded_values.h"
#include "systems/signals/reaction_state.h"
#include "systems/signals/task_energies.h"

namespace flinch {
namespace {

constexpr double noise = 1e-6;  // [J]
constexpr int first_task = 2;

/// How the function of one task changed from tick to tick while nothing touched the robot.
struct Changes {
  int ticks = 0;          ///< with more than noise
  int rises = 0;          ///< of them
  int rises_in_hold = 0;  ///< of them, with a reference at rest
  int ticks_in_hold = 0;
  double risen = 0.0, fallen = 0.0;  ///< [J]
  double largest = 0.0, last = 0.0;  ///< [J]
};

/// A part of a scenario's file, and what shall stand there instead.
using Edits = std::vector<std::pair<std::string, std::string>>;

SimulatedScenario edited(const std::string& name, const Edits& edits) {
  const std::filesystem::path file = FLINCH_SOURCE_DIR "/apps/scenarios/" + name + ".yaml";
  std::string text = read_config_file(file);
  for (const auto& [from, to] : edits) {
    EXPECT_NE(text.find(from), std::string::npos) << from;
    text.replace(text.find(from), from.size(), to);
  }
  return parse_simulated_scenario(text, file);
}

/// Of the entry `number` of TaskEnergies, of the followed law of that kind.
Changes changes_of(const Recording& recording, const std::string& kind, int number) {
  const auto energies = read<TaskEnergies>(recording, "energies_" + kind);
  const auto contacts = read<RecordedContact>(recording, "contact");
  const auto modes = read<ReactionState>(recording, "reaction");
  const auto i = static_cast<std::size_t>(number);
  Changes seen;
  for (std::size_t k = 1; k < recording.samples(); ++k) {
    const TaskEnergies now = energies[k], before = energies[k - 1];
    if (!now.serves(number) || !before.serves(number)) continue;
    const double V = now.energy[i], change = V - before.energy[i];
    EXPECT_GE(V, 0.0);
    seen.largest = std::max(seen.largest, V);
    seen.last = V;
    if (contacts[k].in_contact || contacts[k - 1].in_contact || before.energy[i] < noise) continue;
    const bool holds = modes[k - 1].mode == ReactionMode::hold, rises = change > 0.0;
    ++seen.ticks;
    seen.rises += rises ? 1 : 0;
    seen.ticks_in_hold += holds ? 1 : 0;
    seen.rises_in_hold += holds && rises ? 1 : 0;
    (rises ? seen.risen : seen.fallen) += std::abs(change);
  }
  return seen;
}

void print(const std::string& what, const Changes& seen) {
  std::printf(
      "  %s: rises at %d of %d free ticks, %d of %d in hold, by %.1f mJ, falls by %.1f mJ; largest %.1f mJ, "
      "last %.4f mJ\n",
      what.c_str(), seen.rises, seen.ticks, seen.rises_in_hold, seen.ticks_in_hold, 1e3 * seen.risen,
      1e3 * seen.fallen, 1e3 * seen.largest, 1e3 * seen.last);
}

const Edits ideal{
    {"control:\n", "sensors: {ideal: true}\n\ncontrol:\n  velocity_filter: {cutoff_frequency_Hz: 400}\n"}};

/// Of the signals that hold energies.
std::vector<std::string> energies_with(const std::string& reaction_laws) {
  std::vector<std::string> paths;
  const Recording recording =
      run_experiment(edited("platform_reaction", {{"[torque_reaction]", reaction_laws}}));
  for (const Signal& signal : recording.signals) {
    if (signal.path.starts_with("energies")) paths.push_back(signal.path);
  }
  return paths;
}

// A law that runs for comparison acts on nothing.
TEST(TheLyapunovFunctions, AreThoseOfTheLawThatIsFollowed) {
  EXPECT_EQ(energies_with("[velocity_reaction, torque_reaction]"),
            std::vector<std::string>{"energies_nominal"});
  EXPECT_EQ(energies_with("[torque_reaction, velocity_reaction, strict_reaction]"),
            (std::vector<std::string>{"energies_nominal", "energies_reaction"}));
}

// What (48) asks for: a law that knows the model and the velocity, and a reference at rest. While that moves,
// torques that stay for a tick, change by 20 Nm/ms or reach 100 Nm let it rise at some ticks.
TEST(TheLyapunovFunctionOfAReaction, FallsAtEveryTickWithoutContactWhereTheVelocityIsKnown) {
  for (const std::string body : {"platform", "first_link", "second_link", "clamping"}) {
    const Recording recording = run_experiment(edited(body + "_reaction", ideal));
    const Changes seen = changes_of(recording, "reaction", first_task);
    print(body + ", ideal", seen);
    EXPECT_GT(seen.ticks_in_hold, 50) << body;
    EXPECT_EQ(seen.rises_in_hold, 0) << body;
    EXPECT_LT(seen.rises, 0.15 * seen.ticks) << body;
    EXPECT_LT(seen.last, noise) << body;
  }
}

// With velocities of 30 Hz it rises while the robot accelerates, for it is not the motion that (48) is about.
TEST(TheLyapunovFunctionOfAReaction, FallsOnRealisticRobotsInTheEnd) {
  for (int seed = 1; seed <= 8; ++seed) {
    const Edits realistic{{"\nexpect:", "\nplant: {classification: truth, realism: bench}\n\nexpect:"},
                          {"seed: 1", "seed: " + std::to_string(seed)},
                          {"[torque_reaction]", "[strict_reaction]"},
                          {"limits: {keep: never}", "limits: {keep: always}"}};
    const Recording recording = run_experiment(edited("platform_reaction", realistic));
    const Changes seen = changes_of(recording, "reaction", first_task);
    print("robot " + std::to_string(seed), seen);
    EXPECT_GT(seen.ticks, 300);
    EXPECT_LT(seen.risen, seen.fallen);
    EXPECT_LT(seen.last, 0.01 * seen.largest);
  }
}

// [SafePR] V-E, Fig. 15. Nothing is proven of what comes after another task.
TEST(TheLyapunovFunctions, OfWhatComesFirstFallsAndThoseBelowMayRise) {
  const Recording recording = run_experiment(edited("constraints_without_contact", ideal));
  std::vector<Changes> seen;
  for (int number = 0; number < TaskEnergies::most; ++number) {
    seen.push_back(changes_of(recording, "nominal", number));
    print(std::array{"condition number", "self-collision", "position", "orientation"}.at(
              static_cast<std::size_t>(number)),
          seen.back());
  }
  EXPECT_GT(seen[0].ticks, 100);
  EXPECT_EQ(seen[0].rises, 0);
  EXPECT_GT(seen[1].ticks, 100);
  EXPECT_GT(seen[2].risen, seen[2].fallen) << "the position gives way";
  EXPECT_GT(seen[3].risen, seen[3].fallen) << "and so does the orientation";
}

}  // namespace
}  // namespace flinch
