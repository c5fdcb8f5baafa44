#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "apps/flinch/bus_options.h"

namespace flinch {

/// How a program ends.
enum class ExitStatus : int {
  done = 0,
  bad_verdict = 1,  ///< the run was fine, what it showed is not
  bad_input = 2,    ///< a file or the command line; nothing was written
  fault = 3,        ///< the torque gate closed, and the verdict is bad
};

/// What every verb understands.
struct CommonOptions {
  bool json = false;
  bool quiet = false;
  std::string command_line;  ///< as typed, for the record
};

/// What stands for the robot.
enum class StationKind { simulated, dds, recorded };

struct RunOptions {
  CommonOptions common;
  std::filesystem::path input;  ///< a scenario; with a recorded station, the recording
  std::filesystem::path out;    ///< empty: out/NAME
  std::optional<std::uint64_t> seed;
  std::vector<std::string> set;  ///< values of keys of the scenario, KEY=VALUE
  StationKind station = StationKind::simulated;
  std::vector<std::filesystem::path> classifier;  ///< models to follow; none: as the scenario says
  std::filesystem::path control;  ///< a scenario whose control path replaces the recorded one's; empty: none
  std::vector<std::string> faults;  ///< on request, SIGNAL:KIND@TIME[:SIZE]

  // A robot on the bus.
  BusOptions bus;
  double patience = 10.0;     ///< with a robot that does not answer, or is not enabled [s]
  bool reset_faults = false;  ///< of the drives, before the run
  bool attended = false;      ///< an operator gives orders on stdin, and ends the run
  bool names_a_bus = false;   ///< whether any of these was given
};

struct CampaignOptions {
  CommonOptions common;
  std::filesystem::path file;
  std::filesystem::path out;  ///< empty: out/NAME
  std::vector<std::string> set;
  std::optional<std::size_t> runs;  ///< at each point of the grid
  std::optional<std::uint64_t> seed;
  std::optional<std::size_t> threads;
  std::optional<std::size_t> run;                 ///< only this one, with recording and page
  std::vector<std::filesystem::path> classifier;  ///< models to follow; none: as the scenarios say
  std::filesystem::path false_alarms;             ///< results.csv of a campaign that counts them; empty: none
  bool fresh = false;                             ///< whatever the folder holds
};

struct CalibrateThresholdsOptions {
  CommonOptions common;
  std::vector<std::filesystem::path> recordings;
  std::filesystem::path out;  ///< a YAML file; empty: none
  double rate = 0.5;          ///< of false alarms [1/h]
  double confidence = 0.95;
  double safety_factor = 2.0;
  bool by_component = false;  ///< a threshold for each component of force and moment
  bool one_robot = false;     ///< all recordings are of the one that the thresholds shall serve
};

/// What every calibration from recordings understands.
struct CalibrateOptions {
  CommonOptions common;
  std::vector<std::filesystem::path> recordings;
  std::vector<std::filesystem::path> unseen;  ///< that are not used, but judged by
  std::vector<std::filesystem::path> with;    ///< parameter files that hold already
  std::filesystem::path out;                  ///< a parameter file; empty: none
};

struct CalibrateAllOptions {
  CommonOptions common;
  std::filesystem::path folder;  ///< with recordings anywhere below it
  std::filesystem::path out;     ///< a folder; empty: calibration in that one
  double rate = 0.5;             ///< of false alarms [1/h]
  bool by_component = false;     ///< a threshold for each component
};

struct ExciteOptions {
  CommonOptions common;
  std::filesystem::path robot;
  std::filesystem::path out;
  double duration = 20.0;  ///< [s]
  double distance = 0.2;   ///< of poses from home [m]
  double rotation_deg = 20.0;
  double velocity = 1.5;       ///< [m/s]
  double acceleration = 12.0;  ///< [m/s^2]
  int trials = 2000;
  std::uint64_t seed = 1;
};

struct ImportOptions {
  CommonOptions common;
  std::filesystem::path mapping;
  std::filesystem::path out;
};

struct ReportOptions {
  CommonOptions common;
  std::filesystem::path recording;
  std::filesystem::path out;  ///< empty: beside the recording
};

struct GraphOptions {
  CommonOptions common;
  std::filesystem::path scenario;
  std::filesystem::path out;  ///< a .svg or .dot file; empty: DOT on stdout
};

struct CheckOptions {
  CommonOptions common;
  std::filesystem::path file;
};

/// The verbs. Each throws SetupError for bad input.
ExitStatus run(const RunOptions& options);
ExitStatus campaign(const CampaignOptions& options);
ExitStatus calibrate_thresholds(const CalibrateThresholdsOptions& options);
ExitStatus calibrate_torque_constant(const CalibrateOptions& options);
ExitStatus calibrate_imu_pose(const CalibrateOptions& options);
ExitStatus calibrate_dynamics(const CalibrateOptions& options);
ExitStatus calibrate_all(const CalibrateAllOptions& options);
ExitStatus excite(const ExciteOptions& options);
ExitStatus import_log(const ImportOptions& options);
ExitStatus report(const ReportOptions& options);
ExitStatus graph(const GraphOptions& options);
ExitStatus check(const CheckOptions& options);

/// Parses the command line, carries out its verb and returns the exit status of the program.
int run_command_line(int argc, const char* const* argv);

}  // namespace flinch
