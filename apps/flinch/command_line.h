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

/// A run that is watched in a browser while it goes on.
struct LiveOptions {
  std::string port;    ///< "true": one that is free; empty: not watched
  double speed = 1.0;  ///< of a simulation: simulated seconds in a second
  double wait = 60.0;  ///< for the first page, and at the end for those that have not fetched the report [s]
  bool sets_speed = false;  ///< whether the speed was given
  bool waits = false;       ///< whether the waiting time was

  bool asked() const { return !port.empty(); }
};

struct RunOptions {
  CommonOptions common;
  LiveOptions live;
  std::filesystem::path input;  ///< a scenario; with a recorded station, the recording
  std::filesystem::path out;    ///< empty: out/NAME, on the bus out/NAME_DATE_TIME
  std::optional<std::uint64_t> seed;
  std::vector<std::string> set;        ///< values of keys of the scenario, KEY=VALUE,...; several: a sweep
  std::optional<std::size_t> threads;  ///< of a sweep
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

struct DemoOptions {
  CommonOptions common;
  std::filesystem::path out;  ///< empty: out/demo
};

struct ReproduceOptions {
  CommonOptions common;
  std::filesystem::path file;     ///< of figures; empty: those that come with flinch
  std::filesystem::path out;      ///< empty: out/papers
  std::vector<std::string> only;  ///< ids, or words of ids; none: all
  std::optional<std::size_t> threads;
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

struct SpeedLimitOptions {
  CommonOptions common;
  std::filesystem::path scenario;
  std::filesystem::path out;  ///< empty: out/NAME_speed_limit
  std::vector<std::string> set;
  std::string region;  ///< of the body; empty: as the scenario says
  std::vector<std::string> bodies;
  std::vector<std::string> places;  ///< "X,Y" [m]; none: a grid
  int grid = 5;
  std::optional<double> height;
  int directions = 4;           ///< evenly about the vertical, from 0 degrees on
  std::vector<double> towards;  ///< in place of these [deg]
  std::optional<std::size_t> runs;
  double share = 0.1;
  double confidence = 0.95;
  double slowest = 0.1;  ///< [m/s]
  double fastest = 2.0;
  double step = 0.03;
  std::uint64_t seed = 1;
  std::optional<std::size_t> threads;
  bool fresh = false;
};

struct CalibrateThresholdsOptions {
  CommonOptions common;
  std::vector<std::filesystem::path> recordings;
  std::filesystem::path out;  ///< a YAML file; empty: none
  double rate = 0.5;          ///< of false alarms [1/h]
  double confidence = 0.95;
  double safety_factor = 2.0;
  bool by_component = false;       ///< a threshold for each component of force and moment
  bool one_robot = false;          ///< all recordings are of the one that the thresholds shall serve
  std::filesystem::path scenario;  ///< whose estimators run over logs; empty: that of each log
  std::vector<std::string> free;   ///< stretches of logs without contact, "0..1.3" [s]; none: all
};

/// What every calibration from recordings understands.
struct CalibrateOptions {
  CommonOptions common;
  std::vector<std::filesystem::path> recordings;
  std::vector<std::filesystem::path> unseen;  ///< that are not used, but judged by
  std::vector<std::filesystem::path> with;    ///< parameter files that hold already
  std::filesystem::path out;                  ///< a parameter file; empty: none
  bool accept = false;                        ///< what is found in doubtful readings
};

struct CalibrateAllOptions {
  CommonOptions common;
  std::filesystem::path folder;  ///< with recordings anywhere below it
  std::filesystem::path out;     ///< a folder; empty: calibration in that one
  double rate = 0.5;             ///< of false alarms [1/h]
  bool by_component = false;     ///< a threshold for each component
  bool accept = false;           ///< what is found in doubtful readings
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
  std::filesystem::path mapping;  ///< or, to guess one, the log
  std::filesystem::path out;      ///< empty: nothing is written
  std::filesystem::path page;     ///< empty: none
  bool guess = false;
  std::filesystem::path robot;  ///< to guess by
};

struct ConvertOptions {
  CommonOptions common;
  std::filesystem::path model;        ///< URDF, SDF or MJCF
  std::filesystem::path closures;     ///< pairs of frames that coincide; empty: the model has its own
  std::string platform;               ///< a link or frame
  std::vector<std::string> drives;    ///< joints; none: as the model says
  std::vector<std::string> guess;     ///< about where joints are at home, JOINT=DEGREES, or mm
  std::vector<std::string> massless;  ///< links
  std::filesystem::path out;
};

struct JudgeOptions {
  CommonOptions common;
  std::filesystem::path log;       ///< a recording, of a run or imported
  std::filesystem::path scenario;  ///< empty: that of the recording
  std::vector<std::string> free;   ///< stretches without a contact, A..B [s]
  std::vector<double> contacts;    ///< when contacts begin [s]
  std::string truth;               ///< "force": contacts as the force sensor tells them; empty: as marked
  std::optional<double> contact_force;  ///< Force above which that is a contact [N].
  std::filesystem::path out;            ///< the page; empty: none
};

struct ReportOptions {
  CommonOptions common;
  std::filesystem::path recording;
  std::filesystem::path out;  ///< empty: beside the recording
};

struct ExportOptions {
  CommonOptions common;
  std::filesystem::path recording;   ///< or robot file
  std::string format;                ///< "csv", "mat", "mcap", "npz"; "mjcf" of a robot file
  std::filesystem::path out;         ///< empty: beside the recording
  std::vector<std::string> signals;  ///< none: all
};

struct CompareOptions {
  enum class Align { time, contact, correlation };
  CommonOptions common;
  std::vector<std::filesystem::path> recordings;
  Align align = Align::time;
  std::filesystem::path out = "comparison.html";
};

struct GraphOptions {
  CommonOptions common;
  std::filesystem::path scenario;
  std::filesystem::path out;  ///< a .svg or .dot file; empty: DOT on stdout
};

struct CheckOptions {
  CommonOptions common;
  std::vector<std::filesystem::path> files;
  std::filesystem::path picture;  ///< Of the workspace of the one robot file; empty: none.
};

/// The verbs. Each throws SetupError for bad input.
ExitStatus run(const RunOptions& options);
ExitStatus demo(const DemoOptions& options);
ExitStatus reproduce(const ReproduceOptions& options);
ExitStatus campaign(const CampaignOptions& options);
ExitStatus speed_limit(const SpeedLimitOptions& options);
ExitStatus calibrate_thresholds(const CalibrateThresholdsOptions& options);
ExitStatus calibrate_torque_constant(const CalibrateOptions& options);
ExitStatus calibrate_imu_pose(const CalibrateOptions& options);
ExitStatus calibrate_dynamics(const CalibrateOptions& options);
ExitStatus calibrate_all(const CalibrateAllOptions& options);
ExitStatus excite(const ExciteOptions& options);
ExitStatus import_log(const ImportOptions& options);
ExitStatus convert_model(const ConvertOptions& options);
ExitStatus judge(const JudgeOptions& options);
ExitStatus report(const ReportOptions& options);
ExitStatus export_recording(const ExportOptions& options);
ExitStatus compare(const CompareOptions& options);
ExitStatus graph(const GraphOptions& options);
ExitStatus check(const CheckOptions& options);

/// Parses the command line, carries out its verb and returns the exit status of the program.
int run_command_line(int argc, const char* const* argv);

}  // namespace flinch
