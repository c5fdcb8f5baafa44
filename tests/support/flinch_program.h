#pragma once

#include <string>
#include <vector>

#include "tests/support/other_program.h"

namespace flinch::test {

/// How to start the flinch that is tested, as a program of its own.
inline OtherProgram::Start flinch_program(const std::vector<std::string>& arguments) {
  OtherProgram::Start start{.command = {FLINCH_PROGRAM}, .environment = {}, .preloaded = "", .prepare = {}};
  start.command.insert(start.command.end(), arguments.begin(), arguments.end());
  return start;
}

}  // namespace flinch::test
