#include "apps/flinch/flinch_main.h"

#include <utility>

#include "apps/flinch/command_line.h"
#include "apps/flinch/printing.h"
#include "apps/flinch/program_start.h"
#include "systems/foundation/setup_error.h"

namespace flinch {

int flinch_main(int argc, const char* const* argv, std::vector<RobotKind> kinds) {
  start_program();
  try {
    for (RobotKind& kind : kinds) add_robot_kind(std::move(kind));
  } catch (const SetupError& error) {
    for (const std::string& problem : error.problems()) print_message("error: {}\n", problem);
    return static_cast<int>(ExitStatus::bad_input);
  }
  return run_command_line(argc, argv);
}

}  // namespace flinch
