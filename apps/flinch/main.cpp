#include "apps/flinch/command_line.h"
#include "apps/flinch/program_start.h"

int main(int argc, char** argv) {
  flinch::start_program();
  return flinch::run_command_line(argc, argv);
}
