#pragma once

#include <ostream>
#include <string>
#include <vector>

#include "tests/stations/station_script.h"

/// The four stations, each as a way to play a script.
namespace flinch::test {

/// What a station can show by its nature.
struct StationTraits {
  bool obeys = true;              ///< commands move the robot that is read
  bool waits = false;             ///< there are ticks before the first reading
  bool ends_may_restart = false;  ///< robot and controller are not one program
};

struct ContractStation {
  std::string name;
  StationTraits traits;
  StationRun (*run)(const Script& script);

  friend std::ostream& operator<<(std::ostream& out, const ContractStation& station) {
    return out << station.name;
  }
};

StationRun run_simulated(const Script& script);
StationRun run_mock(const Script& script);
/// Plays a recording of the simulated one, made with the same script.
StationRun run_recorded(const Script& script);
/// A served simulated robot and its station, on one bus. In real time.
StationRun run_dds(const Script& script);

inline std::vector<ContractStation> contract_stations() {
  return {{"Simulated", {.obeys = true, .waits = false, .ends_may_restart = false}, &run_simulated},
          {"Mock", {.obeys = true, .waits = false, .ends_may_restart = false}, &run_mock},
          {"Recorded", {.obeys = false, .waits = true, .ends_may_restart = false}, &run_recorded},
          {"Dds", {.obeys = true, .waits = true, .ends_may_restart = true}, &run_dds}};
}

}  // namespace flinch::test
