// flinch demo: the first thing that a user does.
#include "apps/flinch/command_line.h"
#include "apps/flinch/printing.h"
#include "apps/flinch/shipped_files.h"
#include "systems/foundation/setup_error.h"

namespace flinch {
namespace {

RunOptions run_of(const DemoOptions& options, const char* scenario, const std::filesystem::path& out) {
  RunOptions run;
  run.common = options.common;
  run.input = or_shipped(scenario, "scenarios");
  run.out = out;
  return run;
}

}  // namespace

ExitStatus demo(const DemoOptions& options) {
  if (shipped_folder().empty())
    throw SetupError(
        "the scenarios that come with flinch are not there: neither share/flinch nor apps/ is above the "
        "program; 'flinch run SCENARIO.yaml' runs one by its file");
  const std::filesystem::path out = options.out.empty() ? "out/demo" : options.out;
  if (options.common.json) return run(run_of(options, "platform_collision_fused", out));
  if (!options.common.quiet) print_result("== the best that flinch has: fused detector, strict reaction\n");
  const ExitStatus best = run(run_of(options, "platform_collision_fused", out));
  if (!options.common.quiet)
    print_result("\n== the papers' set-up, the same contact: momentum observer, retraction\n");
  const ExitStatus papers = run(run_of(options, "platform_collision", out / "papers"));
  return best == ExitStatus::done ? papers : best;
}

}  // namespace flinch
