#pragma once

#include <gtest/gtest.h>

#include <optional>

#include "experiments/comparison/comparison.h"
#include "systems/framework/recording.h"
#include "tests/apps/flinch/bus/rig_on_the_bus.h"

namespace flinch::test {

/// A scenario's rig that waits for its controller, and the same scenario in simulation.
struct LockstepRig {
  explicit LockstepRig(const std::string& scenario, std::vector<std::string> faults = {})
      : options_(with_word("--fault", faults)),
        rig(scenario, joined({"--lockstep", "--patience", "120"}, options_)) {
    const Outcome simulated =
        flinch(joined({"run", rig.scenario_file, "--out", rig.place.at("simulated")}, options_));
    EXPECT_NE(simulated.status, 2) << simulated.err;
    status_ = simulated.status;
  }

  /// Runs the scenario on the bus. Says where its recording parts from that of the simulation, in a signal
  /// that both have, or in their lengths; "" where they are the same, bit for bit, and the verdicts as well.
  std::string difference(const std::string& out) const {
    const Outcome live = flinch(joined(rig.run_arguments(out), {"--lockstep", "--patience", "120"}));
    if (live.status != status_)
      return "it ended with " + std::to_string(live.status) + ":\n" + live.out + live.err;
    const Recording one = open_recording(rig.place / "simulated/run.h5");
    const Recording other = open_recording(rig.place / (out + "/run.h5"));
    const auto found = first_difference(one, other);
    if (!found) return "";
    return found->signal + " at " + std::to_string(found->time) + " s";
  }

  static std::vector<std::string> joined(std::vector<std::string> one,
                                         const std::vector<std::string>& other) {
    one.insert(one.end(), other.begin(), other.end());
    return one;
  }

 private:
  static std::vector<std::string> with_word(const std::string& word, const std::vector<std::string>& values) {
    std::vector<std::string> arguments;
    for (const std::string& value : values) arguments.insert(arguments.end(), {word, value});
    return arguments;
  }

  std::vector<std::string> options_;
  int status_ = 0;

 public:
  RigOnTheBus rig;
};

}  // namespace flinch::test
