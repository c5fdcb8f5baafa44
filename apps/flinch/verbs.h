#pragma once

#include <CLI/CLI.hpp>
#include <cstddef>
#include <functional>
#include <optional>
#include <string>

#include "apps/flinch/bus/bus_verbs.h"
#include "apps/flinch/command_line.h"
#include "apps/flinch/learning_verbs.h"
#include "apps/flinch/shipped_files.h"

namespace flinch {

/// Checks without a name of their own, which would stand in the help beside the option's.
template <class Number>
CLI::Validator from_to(Number low, Number high, const std::string& what) {
  return CLI::Validator(
      [low, high, what](const std::string& text) {
        Number value{};
        const bool is_number = CLI::detail::lexical_cast(text, value);
        if (is_number && value >= low && value <= high) return std::string();
        return "is '" + text + "'; it must be a " + what + " from " + CLI::detail::to_string(low) + " to " +
               CLI::detail::to_string(high);
      },
      "");
}
inline CLI::Validator between(int low, int high) { return from_to(low, high, "whole number"); }
/// No NaN is within any.
inline CLI::Validator within(double low, double high) { return from_to(low, high, "number"); }

/// Names of files that come with flinch, in the folder `kind`, are as good as their paths.
inline CLI::Validator shipped(const char* kind) {
  return CLI::Validator(
      [kind](std::string& text) {
        text = or_shipped(text, kind).string();
        return std::string();
      },
      "");
}

/// What is wrong with `text` as a seed; "" if nothing is.
std::string problem_with_seed(const std::string& text);

/// The options that every verb understands.
void add_common(CLI::App& verb, CommonOptions& common);

/// How much is done at once.
void add_threads(CLI::App& verb, std::optional<std::size_t>& threads, const char* help);

/// Lets '-' stand for standard input wherever a verb of `app` reads a file.
void take_standard_input(CLI::App& app);

/// The options by which a run is watched in a browser.
void add_live(CLI::App& run_verb, LiveOptions& live);
/// The option of a robot that is served, whose pace is its own.
void add_live_of_rig(CLI::App& serve_verb, LiveOptions& live);

/// The verbs and their options.
struct Verbs {
  RunOptions run;
  DemoOptions demo;
  ReproduceOptions reproduce;
  CampaignOptions campaign;
  SpeedLimitOptions speed_limit;
  CalibrateThresholdsOptions thresholds;
  DatasetOptions dataset;
  TrainOptions train;
  EvaluateOptions evaluate;
  CalibrateOptions torque_constant;
  CalibrateOptions imu_pose;
  CalibrateOptions dynamics;
  CalibrateAllOptions calibrate_all;
  ExciteOptions excite;
  ImportOptions import_log;
  ConvertOptions convert;
  JudgeOptions judge;
  ServeOptions serve;
  LinkOptions link;
  KeysOptions keys;
  ReportOptions report;
  CompareOptions compare;
  ExportOptions export_recording;
  GraphOptions graph;
  CheckOptions check;
  std::string shell;                   ///< that is to complete
  std::vector<std::string> explained;  ///< verb that help is asked for, and what of it
  std::function<ExitStatus()> chosen;
  CommonOptions* common = nullptr;

  template <class Options>
  CLI::App& add(CLI::App& app, const char* name, const char* help, const char* example, Options& options,
                ExitStatus (*verb)(const Options&)) {
    CLI::App& sub = *app.add_subcommand(name, help);
    sub.footer(std::string("Example:\n  ") + example);
    add_common(sub, options.common);
    sub.callback([this, &options, verb] {
      common = &options.common;
      chosen = [&options, verb] { return verb(options); };
    });
    return sub;
  }
};

/// The verb that finds how fast a robot may move.
void add_speed_limit_verb(CLI::App& app, Verbs& verbs);
/// The verbs that find parameters: `calibrate` with all its kinds, and `excite`.
void add_calibrate_verb(CLI::App& app, Verbs& verbs);
void add_excite_verb(CLI::App& app, Verbs& verbs);
/// The verbs that make data sets and classifiers.
void add_learning_verbs(CLI::App& app, Verbs& verbs);
/// The verbs that only look at files.
void add_file_verbs(CLI::App& app, Verbs& verbs);
/// The verb that makes a recording out of a log of another tool.
void add_import_verb(CLI::App& app, Verbs& verbs);
/// The verb that makes a robot file out of a model of another tool.
void add_convert_verb(CLI::App& app, Verbs& verbs);
/// The verbs that tell shells and `man` of the program. `version`: as --version tells it.
void add_program_verbs(CLI::App& app, Verbs& verbs, const std::string& version);
/// The verb that runs estimators and detectors over a log.
void add_judge_verb(CLI::App& app, Verbs& verbs);

}  // namespace flinch
