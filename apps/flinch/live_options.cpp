// The options of a run that is watched in a browser.
#include <CLI/CLI.hpp>
#include <charconv>
#include <string>

#include "apps/flinch/command_line.h"
#include "apps/flinch/verbs.h"

namespace flinch {
namespace {

/// What is wrong with the text of --live; "" if nothing is.
std::string problem_with_port(const std::string& text) {
  if (text == "true") return "";
  int port = 0;
  const auto [rest, error] = std::from_chars(text.data(), text.data() + text.size(), port);
  const bool is_number = error == std::errc{} && rest == text.data() + text.size();
  if (is_number && port >= 1 && port <= 65535) return "";
  return "is '" + text + "'; it must be a port from 1 to 65535, --live=8080, or nothing for one that is free";
}

void add_port(CLI::App& verb, LiveOptions& live, const std::string& what) {
  verb.add_flag("--live", live.port, what)->check(problem_with_port)->group("Live");
}

}  // namespace

void add_live_of_rig(CLI::App& serve_verb, LiveOptions& live) {
  add_port(serve_verb, live,
           "Show the robot in a browser while it is served, at the address that is printed; --live=PORT "
           "chooses the port. Only this computer, and who knows the address, can see it");
}

void add_live(CLI::App& run_verb, LiveOptions& live) {
  add_port(run_verb, live,
           "Show the run in a browser while it goes on, at the address that is printed; --live=PORT "
           "chooses the port. Only this computer, and who knows the address, can see it. The simulation "
           "then goes by the clock, and buttons pause it, take one tick, and change the speed. In the end "
           "the page becomes the report");
  CLI::Option* const speed = run_verb
                                 .add_option("--live-speed", live.speed,
                                             "Speed of the simulation: 1 is real time, 0.1 a tenth of it [1]")
                                 ->check(within(0.001, 100.0))
                                 ->type_name("FACTOR")
                                 ->group("Live");
  CLI::Option* const wait =
      run_verb
          .add_option(
              "--live-wait", live.wait,
              "Seconds for which a simulation waits for the first page to be open, and for which, in "
              "the end, the report stays for pages that are open and have not fetched it; Ctrl-C ends "
              "that, too [60]")
          ->check(within(0.0, 86400.0))
          ->type_name("S")
          ->group("Live");
  speed->each([&live](const std::string&) { live.sets_speed = true; });
  wait->each([&live](const std::string&) { live.waits = true; });
}

}  // namespace flinch
