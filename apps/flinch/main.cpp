#include "apps/flinch/command_line.h"

int main(int argc, char** argv) { return flinch::run_command_line(argc, argv); }
