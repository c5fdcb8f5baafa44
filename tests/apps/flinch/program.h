#pragma once

#include <string>
#include <vector>

namespace flinch::test {

/// What a run of the program left behind.
struct Outcome {
  int status = 0;
  std::string out;  ///< what it wrote to stdout
  std::string err;  ///< what it wrote to stderr
};

/// Runs run_command_line() with these arguments, in this process.
Outcome flinch(const std::vector<std::string>& arguments);

}  // namespace flinch::test
