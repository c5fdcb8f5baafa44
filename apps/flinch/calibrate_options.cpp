// The command line of flinch calibrate and flinch excite.
#include "apps/flinch/help_layout.h"
#include "apps/flinch/verbs.h"

namespace flinch {
namespace {

constexpr const char* by_component =
    "A threshold for each component of force and moment, which share the alarms; otherwise one for all "
    "of the force and one for all of the moment";

constexpr const char* accept =
    "Take what is found though readings and belief contradict each other; otherwise that is an error";

/// Adds a calibration from recordings, with what all of them understand.
CLI::App& add_calibration(CLI::App& calibrate, Verbs& verbs, const char* kind, const char* help,
                          const char* example, const char* recordings, CalibrateOptions& options,
                          ExitStatus (*verb)(const CalibrateOptions&)) {
  CLI::App& sub = verbs.add(calibrate, kind, help, example, options, verb);
  sub.add_option("recordings", options.recordings, recordings)->required()->type_name("RUN.h5...");
  sub.add_option("-o,--out", options.out,
                 "Write a parameter file, for 'calibrations' of scenarios, and a page beside it")
      ->type_name("FILE.yaml");
  sub.add_flag("--accept", options.accept, accept);
  return sub;
}

void add_fits(CLI::App& calibrate, Verbs& verbs) {
  add_calibration(calibrate, verbs, "torque-constant",
                  "Torque of 1 A at each drive, from rope pulls at a force-torque instrument",
                  "flinch calibrate torque-constant out/pulls/run.h5 --validate out/second/run.h5",
                  "Recordings (HDF5) of pulls at the bodies of one robot; scenario: calibration_pulls.yaml",
                  verbs.torque_constant, &calibrate_torque_constant)
      .add_option("--validate", verbs.torque_constant.unseen,
                  "Recordings of pulls that are not used: how far the estimated forces are off there")
      ->type_name("RUN.h5...");
  CLI::App& dynamics = add_calibration(
      calibrate, verbs, "dynamics",
      "Friction, inertia, cogging, delay of torques; from motion without contact",
      "flinch calibrate dynamics out/excitation/run.h5 --with torque_constant.yaml --out dynamics.yaml",
      "Recordings (HDF5) of one robot without contact; scenario: calibration_excitation.yaml", verbs.dynamics,
      &calibrate_dynamics);
  dynamics
      .add_option("--validate", verbs.dynamics.unseen,
                  "Recordings that are not used: how far the predicted torque is off there")
      ->type_name("RUN.h5...");
  dynamics
      .add_option("--with", verbs.dynamics.with,
                  "Parameter files that hold already: torque constants [those of the recording]")
      ->type_name("FILE.yaml...");
  add_calibration(calibrate, verbs, "imu-pose",
                  "Where the IMU sits on the platform, its biases and delay, from fast motion",
                  "flinch calibrate imu-pose out/rectangle/run.h5 out/standstill/run.h5 --out imu.yaml",
                  "Recordings (HDF5) of one robot without contact; scenario: calibration_rectangle.yaml",
                  verbs.imu_pose, &calibrate_imu_pose);
  CalibrateAllOptions& all = verbs.calibrate_all;
  CLI::App& verb = verbs.add(calibrate, "all", "Everything that a folder of recordings allows, in order",
                             "flinch calibrate all out", all, &calibrate_all);
  verb.add_option("folder", all.folder,
                  "Folder with recordings of the calibration scenarios anywhere below it")
      ->required()
      ->type_name("DIR");
  verb.add_option("-o,--out", all.out, "Folder for the parameter files [DIR/calibration]")->type_name("DIR");
  verb.add_option("--rate", all.rate, "False alarms an hour, of each estimator, for thresholds [0.5]")
      ->check(within(1e-6, 1e6))
      ->type_name("N");
  verb.add_flag("--by-component", all.by_component, by_component);
  verb.add_flag("--accept", all.accept, accept);
}

void add_thresholds(CLI::App& calibrate, Verbs& verbs) {
  CalibrateThresholdsOptions& options = verbs.thresholds;
  CLI::App& verb = verbs.add(
      calibrate, "thresholds",
      "Thresholds of contact detectors for a stated rate of false alarms, from motion without contact",
      "flinch calibrate thresholds out/motion_1/run.h5 out/motion_2/run.h5 --rate 0.5 --out "
      "thresholds.yaml",
      options, &calibrate_thresholds);
  verb.add_option("recordings", options.recordings,
                  "Recordings (HDF5) of motion without contact, of one robot or several")
      ->required()
      ->type_name("RUN.h5...");
  verb.add_option("--scenario", options.scenario,
                  "Of imported logs: the scenario whose estimators run over them [that of the log]")
      ->transform(shipped("scenarios"))
      ->type_name("SCENARIO.yaml");
  verb.add_option("--free", options.free,
                  "Of imported logs: a stretch without contact, in s; any number of them [all of each log]")
      ->allow_extra_args(false)
      ->type_name("A..B");
  verb.add_option("--rate", options.rate, "False alarms an hour, of each estimator [0.5]")
      ->check(within(1e-6, 1e6))
      ->type_name("N");
  verb.add_option("--confidence", options.confidence, "With which the rate is kept, 0.5 to 0.9999 [0.95]")
      ->check(within(0.5, 0.9999))
      ->type_name("P");
  verb.add_option(
          "--safety-factor", options.safety_factor,
          "Of the papers' rule, a multiple of the largest value seen, which is told for comparison [2]")
      ->check(within(1.0, 100.0))
      ->type_name("K");
  verb.add_flag("--by-component", options.by_component, by_component);
  verb.add_flag(
      "--one-robot", options.one_robot,
      "All recordings are of the robot that the thresholds shall serve; otherwise each counts as one of "
      "many, and others may differ as these do");
  verb.add_option("-o,--out", options.out,
                  "Write the thresholds as a parameter file, for 'calibrations' of scenarios")
      ->type_name("FILE.yaml");
}

}  // namespace

void add_calibrate_verb(CLI::App& app, Verbs& verbs) {
  CLI::App& calibrate = *app.add_subcommand("calibrate", "Find parameters from recordings");
  calibrate.require_subcommand(1);
  calibrate.formatter(std::make_shared<HelpLayout>());  // not the one that it shares with the program
  calibrate.get_formatter()->label("SUBCOMMAND", "WHAT");
  add_thresholds(calibrate, verbs);
  add_fits(calibrate, verbs);
}

void add_excite_verb(CLI::App& app, Verbs& verbs) {
  ExciteOptions& options = verbs.excite;
  CLI::App& verb =
      verbs.add(app, "excite", "Design a motion from which the dynamics of a robot can be told",
                "flinch excite apps/robots/planar_3rrr.yaml --out excitation.yaml", options, &excite);
  const auto above_zero = within(1e-3, 1e4);
  verb.add_option("robot", options.robot, "Robot file (YAML), with its limits")
      ->required()
      ->type_name("ROBOT.yaml");
  verb.add_option("-o,--out", options.out, "The scenario that is written")
      ->required()
      ->type_name("SCENARIO.yaml");
  verb.add_option("--duration", options.duration, "Seconds of motion [20]")
      ->check(above_zero)
      ->type_name("S");
  verb.add_option("--distance", options.distance, "Metres of poses from home [0.2]")
      ->check(above_zero)
      ->type_name("M");
  verb.add_option("--rotation", options.rotation_deg, "Degrees of poses against home [20]")
      ->check(within(0.0, 90.0))
      ->type_name("DEG");
  verb.add_option("--velocity", options.velocity, "Of the platform [1.5 m/s]")
      ->check(above_zero)
      ->type_name("V");
  verb.add_option("--acceleration", options.acceleration, "Of the platform [12 m/s^2]")
      ->check(above_zero)
      ->type_name("A");
  verb.add_option("--trials", options.trials, "Poses that are tried in the place of others [2000]")
      ->check(between(1, 1'000'000))
      ->type_name("N");
  verb.add_option("--seed", options.seed, "Of the search [1]")->check(problem_with_seed)->type_name("N");
}

void add_import_verb(CLI::App& app, Verbs& verbs) {
  ImportOptions& options = verbs.import_log;
  CLI::App& verb =
      verbs.add(app, "import", "Make a recording of readings out of a log of another tool",
                "flinch import log.csv --guess --robot apps/robots/planar_3rrr.yaml --out out/log/run.h5",
                options, &import_log);
  verb.add_option(
          "mapping", options.mapping,
          "What the columns are (YAML; docs/files.md has the keys); with --guess the log: CSV or other text, "
          "HDF5, MATLAB 7.3")
      ->required()
      ->type_name("MAPPING.yaml|LOG");
  verb.add_flag(
      "--guess", options.guess,
      "Propose a mapping from names, units and ranges of the columns, and from how the robot can stand");
  verb.add_option("--robot", options.robot, "The robot of which the log is")->type_name("ROBOT.yaml");
  verb.add_option("-o,--out", options.out, "The recording that is written")->type_name("RUN.h5");
  verb.add_option("--page", options.page, "Page with all that was read, on one time cursor [none]")
      ->type_name("PAGE.html");
}

void add_judge_verb(CLI::App& app, Verbs& verbs) {
  JudgeOptions& options = verbs.judge;
  CLI::App& verb = verbs.add(
      app, "judge", "Tell what the estimators and detectors of a scenario would have detected in a log",
      "flinch judge out/log/run.h5 --scenario apps/scenarios/square.yaml --free 0..1.3 --contact 1.337",
      options, &judge);
  verb.add_option("log", options.log, "A recording, imported or of a run")->required()->type_name("LOG.h5");
  verb.add_option("--scenario", options.scenario,
                  "Whose control path runs over it; without it that of the log")
      ->transform(shipped("scenarios"))
      ->type_name("S.yaml");
  verb.add_option("--free", options.free,
                  "A stretch in which nothing touches the robot: what is detected there is a false alarm [s]")
      ->type_name("A..B")
      ->allow_extra_args(false);
  verb.add_option("-o,--out", options.out, "Page with what estimators made of it [none]")
      ->type_name("PAGE.html");
  verb.add_option("--contact", options.contacts, "When a contact begins [s]")
      ->type_name("T")
      ->allow_extra_args(false);
  verb.add_option("--truth", options.truth,
                  "Who says what is contact and what is free: the force sensor of the log; --free then marks "
                  "where its zero is taken from [what --contact and --free mark]")
      ->check(CLI::IsMember({"force"}))
      ->type_name("force");
  verb.add_option("--contact-force", options.contact_force,
                  "Force above which --truth force tells a contact, until it is below half of that for 0.1 s "
                  "[2 N, or six deviations of the sensor's noise if that is more]")
      ->type_name("NEWTON");
}

}  // namespace flinch
