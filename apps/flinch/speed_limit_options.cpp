// The command line of flinch speed-limit.
#include "apps/flinch/verbs.h"

namespace flinch {
namespace {

/// Which contacts are tried.
void add_cells(CLI::App& verb, SpeedLimitOptions& options) {
  verb.add_option("--body", options.bodies,
                  "Body that runs into the obstacle: platform, link1, link2 of any leg, clamping between the "
                  "links of a leg; any number of them [platform, link1, link2]")
      ->allow_extra_args(false)
      ->type_name("NAME");
  verb.add_option(
          "--region", options.region,
          "Region of the human body whose force limits hold: hand, lower_arm, chest, face, ... [as the "
          "scenario says]")
      ->type_name("NAME");
  verb.add_option("--grid", options.grid, "Places along the longer side of the workspace [5]")
      ->check(between(1, 200))
      ->type_name("N");
  verb.add_option(
          "--at", options.places,
          "Place of the platform in the base frame, X,Y in m, instead of the grid; any number of them")
      ->allow_extra_args(false)
      ->type_name("X,Y");
  verb.add_option("--z", options.height, "Height of the platform in space, in m [the scenario's pose]")
      ->check(within(-100.0, 100.0))
      ->type_name("Z");
  verb.add_option("--directions", options.directions,
                  "Directions of the motion, evenly about the vertical from the x axis on [4]")
      ->check(between(1, 360))
      ->type_name("N");
  verb.add_option("--towards", options.towards,
                  "Direction of the motion against the x axis, in degrees, instead; any number of them")
      ->allow_extra_args(false)
      ->check(within(-360.0, 360.0))
      ->type_name("DEG");
}

/// What is asked of them.
void add_search(CLI::App& verb, SpeedLimitOptions& options) {
  verb.add_option("--share", options.share,
                  "Fraction of contacts below which those must be that exceed a limit [0.1]")
      ->check(within(0.001, 0.5))
      ->type_name("P");
  verb.add_option("--confidence", options.confidence, "That it is below, in each cell by itself [0.95]")
      ->check(within(0.5, 0.9999))
      ->type_name("C");
  verb.add_option(
          "--runs", options.runs,
          "Contacts of each cell that come about, a quarter more are drawn; more find a limit that is "
          "nearer to the true one [as few as can show the share: 29]")
      ->check(between(1, 1'000'000))
      ->type_name("N");
  verb.add_option("--slowest", options.slowest, "Lowest speed that is tried, in m/s [0.1]")
      ->check(within(0.01, 100.0))
      ->type_name("V");
  verb.add_option("--fastest", options.fastest, "Highest speed that is tried, in m/s [2]")
      ->check(within(0.01, 100.0))
      ->type_name("V");
  verb.add_option("--step", options.step, "Relative distance of the speeds that are told apart [0.03]")
      ->check(within(0.001, 1.0))
      ->type_name("X");
}

}  // namespace

void add_speed_limit_verb(CLI::App& app, Verbs& verbs) {
  SpeedLimitOptions& options = verbs.speed_limit;
  CLI::App& verb = verbs.add(
      app, "speed-limit",
      "How fast may it move? Limit speeds over the workspace, so that contacts stay within force limits",
      "flinch speed-limit platform_collision\n"
      "  flinch speed-limit platform_collision --body platform --at -0.04,0 --towards 180 --runs 93",
      options, &speed_limit);
  verb.add_option("scenario", options.scenario,
                  "Scenario file (YAML) with a passage and an obstacle, or the name of one that comes with "
                  "flinch")
      ->required()
      ->type_name("SCENARIO");
  add_cells(verb, options);
  add_search(verb, options);
  verb.add_option("--set", options.set, "Value of a key of the scenario; any number of times")
      ->allow_extra_args(false)
      ->type_name("KEY=VALUE");
  verb.add_option("--seed", options.seed, "Seed of all that is drawn [1]")
      ->check(problem_with_seed)
      ->type_name("N");
  verb.add_option("-o,--out", options.out, "Folder for the map and its tables [out/NAME_speed_limit]")
      ->type_name("DIR");
  add_threads(verb, options.threads, "Cells at once [one a processor]");
  verb.add_flag("--fresh", options.fresh, "Begin anew, whatever the folder holds already");
}

}  // namespace flinch
