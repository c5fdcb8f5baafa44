#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <string>

#include "systems/framework/time.h"
#include "systems/signals/plausibility.h"

namespace flinch {
struct SimulatedScenario;
}

/// How near honest robots come to be called liars.
namespace flinch::test {

/// What is mounted on them.
struct MountedSensors {
  bool passive_encoders = true;
  bool imu = true;
};

struct Margins {
  std::size_t runs = 0;
  double seconds = 0.0;     ///< with an open gate
  std::size_t touched = 0;  ///< runs with a contact
  double peak_force = 0.0;  ///< largest of a contact [N]
  std::map<GateFault, int> alarms;
  std::array<double, plausibility_checks> largest{};  ///< statistic over threshold

  void add(const Margins& other);
  int false_alarms() const;
  std::string table() const;
};

/// Runs until the end of the scenario and looks at every tick until a fault closes the gate.
Margins margins_of(SimulatedScenario scenario, const MountedSensors& sensors);

/// The first runs of a campaign file, on two threads, with another control period where one is given.
/// Contacts of more than 800 N are left out.
Margins margins_of_campaign(const std::string& file, std::size_t runs, const MountedSensors& sensors,
                            Time period = 1ms);

}  // namespace flinch::test
