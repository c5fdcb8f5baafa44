#include "apps/flinch/command_line.h"

#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <limits>
#include <new>
#include <nlohmann/json.hpp>
#include <sstream>

#include "apps/flinch/commit.h"
#include "apps/flinch/help_layout.h"
#include "apps/flinch/learning_verbs.h"
#include "apps/flinch/printing.h"
#include "apps/flinch/shell_word.h"
#include "apps/flinch/verbs.h"
#include "systems/foundation/json_text.h"
#include "systems/foundation/nearest_name.h"
#include "systems/foundation/setup_error.h"

namespace flinch {
namespace {

/// A finite number of seconds; "" if it is.
std::string problem_with_seconds(const std::string& text) {
  double seconds = 0.0;
  const bool is_number = CLI::detail::lexical_cast(text, seconds);
  if (is_number && seconds > 0.0 && seconds <= 1e6) return "";
  return "is '" + text + "'; it must be a number of seconds above 0 and up to 1e6";
}

constexpr const char* which_robot =
    "Robot to command, by its name or identity, where several are there [the only one]";

void add_bus(CLI::App& verb, BusOptions& bus, const char* robot) {
  verb.add_option("--robot", bus.robot, robot)->type_name("ID")->group("Bus");
  verb.add_option("--domain", bus.domain,
                  "Number of the bus; programs with the same number hear each other [0]")
      ->check(between(0, 230))
      ->type_name("N")
      ->group("Bus");
  verb.add_option(
          "--interface", bus.interface,
          "Network interface, name or address; nothing else is heard, and with lo only this machine [lo]")
      ->type_name("NAME")
      ->group("Bus");
  verb.add_option("--peer", bus.peers,
                  "Address of the other end, where the network has no multicast; any number of them")
      ->type_name("ADDRESS")
      ->group("Bus");
  verb.add_option("--security", bus.security, "Folder that flinch keys made; both ends need it [none]")
      ->type_name("DIR")
      ->group("Bus");
  verb.add_flag("--anyone-may-command", bus.anyone_may_command,
                "Go on a network without keys, where whoever reaches it can move the robot")
      ->group("Bus");
  verb.add_option("--priority", bus.priority,
                  "Real-time priority of loop and bus, 1 to 99, where permitted; 0 for none [80]")
      ->check(between(0, 99))
      ->type_name("N")
      ->group("Bus");
}

void add_pace(CLI::App& verb, BusOptions& bus, const char* lockstep, const char* real_time) {
  CLI::Option* const waits = verb.add_flag("--lockstep", bus.lockstep, lockstep)->group("Bus");
  verb.add_flag("--real-time", bus.real_time, real_time)->group("Bus")->excludes(waits);
}

void add_fault(CLI::App& verb, std::vector<std::string>& faults) {
  verb.add_option(
          "--fault", faults,
          "Fault to inject from TIME [s] on: SIGNAL:KIND@TIME[:SIZE], such as "
          "encoder2:drifting@0.5:-5. SIGNAL: encoder, passive_encoder, current, drive, brake, each with "
          "its number or as encoders etc. for all; gyroscope, accelerometer, imu, force_torque, status, "
          "link. KIND: off, stuck, noise, wrong, drifting, scaled, delayed, intermittent, reversed, "
          "saturated, turned. Any number of them")
      ->allow_extra_args(false)
      ->type_name("FAULT");
}

std::string typed(int argc, const char* const* argv) {
  std::string text = "flinch";
  for (int i = 1; i < argc; ++i) text += " " + shell_word(argv[i]);
  return text;
}

/// A name with a line feed begins no line that looks like one of ours.
std::string indented(std::string text) {
  for (std::size_t at = text.find('\n'); at != std::string::npos; at = text.find('\n', at + 1))
    text.insert(at + 1, "       ");
  return text;
}

int complain(const std::vector<std::string>& problems, bool json) {
  if (json) print_results(json_text(nlohmann::ordered_json{{"error", problems}}) + "\n");
  flush_results();
  constexpr std::size_t most_shown = 50;
  for (std::size_t i = 0; i < std::min(problems.size(), most_shown); ++i) {
    print_message("error: {}\n", indented(problems[i]));
  }
  if (problems.size() > most_shown) {
    print_message("error: {} more problems are not shown\n", problems.size() - most_shown);
  }
  return static_cast<int>(ExitStatus::bad_input);
}

/// Puts the number of the station that `text` names in its place; what is wrong with it, "" if nothing is.
std::string number_of_station(std::string& text) {
  const std::vector<std::string> names = {"simulated", "dds", "recorded"};  // as StationKind
  const auto found = std::find(names.begin(), names.end(), text);
  if (found == names.end()) return "is '" + text + "', which is no station" + did_you_mean(text, names);
  text = std::to_string(found - names.begin());
  return "";
}

void add_demo_verb(CLI::App& app, Verbs& verbs) {
  verbs
      .add(app, "demo", "Simulate one collision, at its best and as the papers have it",
           "flinch demo && xdg-open out/demo/report.html", verbs.demo, &demo)
      .add_option("-o,--out", verbs.demo.out, "Folder for run.h5 and report.html [out/demo]")
      ->type_name("DIR");
}

/// What of the scenario is run, and into which folder.
void add_what_is_run(CLI::App& run_verb, Verbs& verbs) {
  run_verb
      .add_option(
          "input", verbs.run.input,
          "Scenario file (YAML), or the name of one that comes with flinch; with --station recorded, a "
          "recording (HDF5)")
      ->required()
      ->type_name("FILE");
  run_verb
      .add_option("--station", verbs.run.station,
                  "What stands for the robot: simulated, dds (a robot on the bus), recorded [simulated]")
      ->transform(CLI::Validator(number_of_station, ""))
      ->type_name("KIND");
  run_verb
      .add_option(
          "--control", verbs.run.control,
          "With --station recorded: the scenario whose control path shall run [that of the recording]")
      ->type_name("SCENARIO.yaml");
  run_verb
      .add_option(
          "--classifier", verbs.run.classifier,
          "Model (ONNX) of flinch train that tells what is touched; of the papers' questions all three, "
          "each with an option of its own [as the scenario says]")
      ->allow_extra_args(false)
      ->type_name("MODEL.onnx");
  run_verb.add_option("-o,--out", verbs.run.out, "Folder of run.h5, report.html [out/NAME, on a bus dated]")
      ->type_name("DIR");
  run_verb.add_option("--seed", verbs.run.seed, "Seed of all noise, instead of the scenario's")
      ->check(problem_with_seed)
      ->type_name("N");
  run_verb
      .add_option("--set", verbs.run.set,
                  "Value of a key of the scenario, instead of the file's; any number of times. Several "
                  "values, 1,2,5 or FIRST..LAST:STEP or FIRST..LAST:*FACTOR, make a sweep: a run for each, a "
                  "row for each run, and a page of curves; several such keys make a grid. A number for a "
                  "list of numbers stands for each of them; a key without its unit is in SI")
      ->allow_extra_args(false)
      ->type_name("KEY=VALUE");
}

/// How long a run on the bus waits, and for whom.
void add_patience(CLI::App& run_verb, Verbs& verbs) {
  run_verb
      .add_option(
          "--patience", verbs.run.patience,
          "Seconds to wait until the robot answers, again for its drives, and when it falls silent [10]")
      ->check(problem_with_seconds)
      ->type_name("S")
      ->group("Bus");
  run_verb
      .add_flag("--reset-faults", verbs.run.reset_faults,
                "Reset faults that the drives report; without it they end the run before it begins")
      ->group("Bus");
  run_verb
      .add_flag(
          "--attended", verbs.run.attended,
          "An operator sees the robot: follow the orders that he types (stop, reset, start, go, step, end; "
          "help tells more), and run until he ends it")
      ->group("Bus");
}

void add_run_verb(CLI::App& app, Verbs& verbs) {
  CLI::App& run_verb = verbs.add(app, "run", "Run one experiment: verdict, recording, report",
                                 "flinch run apps/scenarios/platform_collision.yaml --out out/demo\n"
                                 "  flinch run apps/scenarios/platform_collision.yaml --set "
                                 "control.momentum_observer.gain=20..400:20",
                                 verbs.run, &run);
  add_what_is_run(run_verb, verbs);
  add_threads(run_verb, verbs.run.threads, "Of a sweep: runs at once [one a processor]");
  add_fault(run_verb, verbs.run.faults);
  add_live(run_verb, verbs.run.live);
  add_bus(run_verb, verbs.run.bus, which_robot);
  add_pace(run_verb, verbs.run.bus,
           "Go in lockstep with a simulated robot: both wait for one another, so that the run is, bit for "
           "bit, the one in simulation [as the robot does]",
           "Go by the clock, as with every real robot [as the robot does]");
  add_patience(run_verb, verbs);
  const auto is_of_bus = [](const CLI::Option* option) { return option->get_group() == "Bus"; };
  for (CLI::Option* const option : run_verb.get_options(is_of_bus))
    option->each([&verbs](const std::string&) { verbs.run.names_a_bus = true; });
}

void add_reproduce_verb(CLI::App& app, Verbs& verbs) {
  ReproduceOptions& options = verbs.reproduce;
  CLI::App& verb = verbs.add(
      app, "reproduce", "Run what the papers show: each of their figures beside ours, in one table and page",
      "flinch reproduce --only table4", options, &reproduce);
  verb.add_option("figures", options.file, "File of figures (YAML) [those of the papers]")
      ->type_name("FIGURES.yaml");
  verb.add_option("--only", options.only,
                  "Only figures with this id, or this word of one: 'table4', 'safepr', 'fig22.slowest'; any "
                  "number of times")
      ->allow_extra_args(false)
      ->type_name("ID");
  verb.add_option("-o,--out", options.out, "Folder for papers.html and the campaigns [out/papers]")
      ->type_name("DIR");
  add_threads(verb, options.threads, "Runs at once [one a processor]");
}

void add_campaign_verb(CLI::App& app, Verbs& verbs) {
  CampaignOptions& options = verbs.campaign;
  CLI::App& verb =
      verbs.add(app, "campaign", "Run a scenario many times with other values: one table of what it shows",
                "flinch campaign apps/campaigns/random_contacts.yaml --set "
                "'control.momentum_observer.gain_per_s=[20,20,20],[100,100,100]'",
                options, &campaign);
  verb.add_option("campaign", options.file, "Campaign file (YAML), or the name of one that comes with flinch")
      ->required()
      ->transform(shipped("campaigns"))
      ->type_name("CAMPAIGN.yaml");
  verb.add_option("--set", options.set,
                  "Values of a key of the scenario, one axis of the grid; any number of times")
      ->allow_extra_args(false)
      ->type_name("KEY=V,V...");
  verb.add_option("--runs", options.runs, "Runs at each point of the grid [the file's]")
      ->check(between(1, 10'000'000))
      ->type_name("N");
  verb.add_option("--seed", options.seed, "Seed of all that is drawn [the file's]")
      ->check(problem_with_seed)
      ->type_name("N");
  verb.add_option("--run", options.run, "Do only this run of the table again, with recording and report")
      ->check(between(0, std::numeric_limits<int>::max()))
      ->type_name("NUMBER");
  verb.add_option(
          "--classifier", options.classifier,
          "Model (ONNX) of flinch train that tells what is touched; of the papers' questions all three, "
          "each with an option of its own [as the scenarios say]")
      ->allow_extra_args(false)
      ->type_name("MODEL.onnx");
  verb.add_option("--false-alarms", options.false_alarms,
                  "Results of another campaign with the same grid whose false alarms the report shows")
      ->type_name("RESULTS.csv");
  verb.add_option("-o,--out", options.out, "Folder for results.csv and results.h5 [out/NAME]")
      ->type_name("DIR");
  add_threads(verb, options.threads, "Runs at once [one a processor]");
  verb.add_flag("--fresh", options.fresh, "Begin anew, whatever the folder holds already");
}

void add_bus_verbs(CLI::App& app, Verbs& verbs) {
  CLI::App& serve_verb =
      verbs.add(app, "serve", "Put the simulated robot of a scenario on the bus, as if it were there",
                "flinch serve apps/scenarios/platform_collision.yaml --duration 60", verbs.serve, &serve);
  serve_verb
      .add_option("scenario", verbs.serve.scenario,
                  "Scenario file (YAML), or the name of one that comes with flinch")
      ->required()
      ->transform(shipped("scenarios"))
      ->type_name("SCENARIO.yaml");
  serve_verb.add_option("--seed", verbs.serve.seed, "Seed of all noise, instead of the scenario's")
      ->check(problem_with_seed)
      ->type_name("N");
  serve_verb.add_option("--duration", verbs.serve.duration, "Seconds to serve [until Ctrl-C]")
      ->check(problem_with_seconds)
      ->type_name("S");
  serve_verb
      .add_option("--patience", verbs.serve.patience,
                  "Seconds to wait, in lockstep, for a controller that sends nothing [10]")
      ->check(problem_with_seconds)
      ->type_name("S")
      ->group("Bus");
  add_live_of_rig(serve_verb, verbs.serve.live);
  add_fault(serve_verb, verbs.serve.faults);
  add_bus(serve_verb, verbs.serve.bus, "Name of this robot, to choose it by among several [none]");
  add_pace(serve_verb, verbs.serve.bus,
           "Wait for the controller at each tick, however late it is [without real-time rights]",
           "Go by the clock, as a real robot does [with real-time rights]");

  CLI::App& link_verb =
      verbs.add(app, "link", "Measure how fast and how surely a robot on the bus answers, without moving it",
                "flinch link apps/robots/planar_3rrr.yaml --duration 60", verbs.link, &link);
  link_verb
      .add_option("robot", verbs.link.robot,
                  "Robot file, or a scenario that names it (YAML); both ends must have the same")
      ->required()
      ->type_name("FILE");
  link_verb.add_option("--duration", verbs.link.duration, "Seconds to measure [10]")
      ->check(problem_with_seconds)
      ->type_name("S");
  link_verb.add_option("--patience", verbs.link.patience, "Seconds to wait for the robot [10]")
      ->check(problem_with_seconds)
      ->type_name("S");
  add_bus(link_verb, verbs.link.bus, which_robot);
}

void add_keys_verb(CLI::App& app, Verbs& verbs) {
  CLI::App& keys_verb = verbs.add(app, "keys", "Make keys that keep others off the bus of a robot",
                                  "flinch keys keys --days 365", verbs.keys, &keys);
  keys_verb.add_option("folder", verbs.keys.folder, "New folder for the keys")->required()->type_name("DIR");
  keys_verb.add_option("--days", verbs.keys.days, "How long they are good [1096]")
      ->check(between(1, 36500))
      ->type_name("N");
  keys_verb.add_option("--domain", verbs.keys.domain, "The only domain of the bus they are good for [all]")
      ->check(between(0, 230))
      ->type_name("N");
  keys_verb.add_flag("--force", verbs.keys.force, "Replace the keys that are there");
}

/// Of a program its verbs, of a verb what it can be told to do.
std::vector<std::string> subcommands_of(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* sub : app.get_subcommands([](const CLI::App*) { return true; }))
    names.push_back(sub->get_name());
  return names;
}

/// "" where all options of `verb`, which is called `path`, are known.
std::string problem_with_options(const CLI::App& verb, const std::string& path) {
  const std::vector<std::string> extra = verb.remaining();
  const auto unknown =
      std::find_if(extra.begin(), extra.end(), [](const std::string& text) { return text.starts_with('-'); });
  if (unknown == extra.end()) return "";
  std::vector<std::string> names;
  for (const CLI::Option* option : verb.get_options())
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  const std::string name = unknown->substr(0, unknown->find('='));
  return "'" + name + "' is no option of '" + path + "'" + did_you_mean(name, names);
}

/// The error of the parser, with the way out.
std::string usage_problem(const CLI::App& app, const CLI::ParseError& error, const std::string& first) {
  if (app.get_subcommands().empty()) {
    const std::vector<std::string> verbs = subcommands_of(app);
    if (first.empty() || first.starts_with('-')) return "there is no verb" + did_you_mean(first, verbs);
    return "'" + first + "' is no verb" + did_you_mean(first, verbs);
  }
  std::string path = "flinch";
  const CLI::App* verb = &app;
  while (!verb->get_subcommands().empty()) {
    verb = verb->get_subcommands().front();
    path += " " + verb->get_name();
  }
  if (!subcommands_of(*verb).empty())
    return "'" + verb->get_name() + "' needs a kind" + did_you_mean("", subcommands_of(*verb));
  const std::string unknown = problem_with_options(*verb, path);
  return unknown.empty() ? fmt::format("{}; '{} --help' shows how", error.what(), path) : unknown;
}

/// Shows help or version.
int show(const CLI::App& app, const CLI::ParseError& asked, bool json) {
  std::ostringstream out, err;
  const int status = app.exit(asked, out, err);
  print_results(out.str());
  try {
    require_printed();
  } catch (const SetupError& lost) {
    return complain(lost.problems(), json);
  }
  return status;
}

}  // namespace

/// What is wrong with `text` as a seed; "" if nothing is.
std::string problem_with_seed(const std::string& text) {
  std::uint64_t seed = 0;
  const char* const end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, seed);
  if (error == std::errc{} && rest == end) return "";
  return "is '" + text + "'; it must be a whole number between 0 and 2^64 - 1";
}

void add_common(CLI::App& verb, CommonOptions& common) {
  verb.add_flag("--json", common.json, "Print one JSON object on stdout; messages go to stderr");
  verb.add_flag("-q,--quiet", common.quiet, "Print nothing but results and errors");
}

void add_threads(CLI::App& verb, std::optional<std::size_t>& threads, const char* help) {
  verb.add_option("--threads", threads, help)->check(between(1, 1024))->type_name("N");
}

int run_command_line(int argc, const char* const* argv) {
  CLI::App app("flinch: contact detection and reaction for parallel robots. Not a certified safety function.",
               "flinch");
  const std::string version =
      fmt::format("flinch {}{}", FLINCH_VERSION, commit.empty() ? "" : fmt::format(" ({})", commit));
  app.set_version_flag("--version", version);
  app.require_subcommand(1);
  app.formatter(std::make_shared<HelpLayout>());
  app.get_formatter()->label("SUBCOMMAND", "VERB");
  app.footer(
      "'-' in the place of an input file is standard input.\n"
      "Exit status: 0 done, 1 verdict or link failed, 2 bad input or usage,\n"
      "3 a fault stopped the run.\n"
      "'flinch VERB --help' shows the options of a verb.");
  add_network_stages();
  Verbs verbs;
  add_demo_verb(app, verbs);
  add_run_verb(app, verbs);
  add_file_verbs(app, verbs);
  add_campaign_verb(app, verbs);
  add_speed_limit_verb(app, verbs);
  add_reproduce_verb(app, verbs);
  add_calibrate_verb(app, verbs);
  add_learning_verbs(app, verbs);
  add_excite_verb(app, verbs);
  add_import_verb(app, verbs);
  add_convert_verb(app, verbs);
  add_judge_verb(app, verbs);
  add_bus_verbs(app, verbs);
  add_keys_verb(app, verbs);
  add_program_verbs(app, verbs, version);
  take_standard_input(app);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    const bool json = std::find(argv, argv + argc, std::string("--json")) != argv + argc;
    if (error.get_exit_code() == 0) return show(app, error, json);
    return complain({usage_problem(app, error, argc > 1 ? argv[1] : "")}, json);
  }
  verbs.common->command_line = typed(argc, argv);
  try {
    const ExitStatus status = verbs.chosen();
    require_printed();
    return static_cast<int>(status);
  } catch (const SetupError& error) {
    return complain(error.problems(), verbs.common->json);
  } catch (const std::bad_alloc&) {
    return complain({"there is not enough memory"}, verbs.common->json);
  } catch (const std::exception& error) {  // of the system: a folder that may not be read, no more threads
    return complain({error.what()}, verbs.common->json);
  }
}

}  // namespace flinch
