#pragma once

#include <iostream>
#include <optional>
#include <string>
#include <vector>

#include "tests/apps/flinch/program.h"
#include "tests/support/flinch_program.h"
#include "tests/support/free_domain.h"
#include "tests/support/machine_monitor.h"
#include "tests/support/workplace.h"

namespace flinch::test {

/// A scenario's rig, served by another program on a bus of its own, with a place for results.
struct RigOnTheBus {
  explicit RigOnTheBus(const std::string& scenario = "platform_collision",
                       const std::vector<std::string>& how = {"--real-time", "--json"})
      : scenario_file(place.at("scenarios/" + scenario + ".yaml")), served(how), server(serving()) {}

  /// The arguments of a verb on this bus.
  std::vector<std::string> on_bus(std::vector<std::string> arguments) const {
    arguments.insert(arguments.end(), {"--domain", domain});
    return arguments;
  }
  std::vector<std::string> run_arguments(const std::string& out = "live") const {
    return on_bus({"run", scenario_file, "--station", "dds", "--out", place.at(out)});
  }

  /// Runs the scenario there. Where a fault stops it and the machine has taken the processor away meanwhile,
  /// which is no concern of who calls this, it runs again, three times at most, and says so: before another
  /// robot, for the first may have stopped in contact.
  Outcome run(const std::vector<std::string>& arguments) const {
    Outcome outcome = flinch(arguments);
    for (int again = 0; again < 2 && outcome.status == 3 && machine_stall() > noticeable_stall; ++again) {
      std::cout << "stopped by a fault, trying once more:\n" << outcome.out << outcome.err << std::endl;
      server.emplace(serving());
      outcome = flinch(arguments);
    }
    return outcome;
  }

  OtherProgram::Start serving() const {
    std::vector<std::string> arguments = {"serve",    scenario_file, "--robot",    "bench",
                                          "--domain", domain,        "--duration", "120"};
    arguments.insert(arguments.end(), served.begin(), served.end());
    return flinch_program(arguments);
  }

  Workplace place;
  std::string domain = std::to_string(free_domain());
  std::string scenario_file;
  std::vector<std::string> served;  ///< options of the program that serves it
  mutable std::optional<OtherProgram> server;
};

}  // namespace flinch::test
