#include "tests/apps/flinch/program.h"

#include <gtest/gtest.h>

#include "apps/flinch/command_line.h"

namespace flinch::test {

Outcome flinch(const std::vector<std::string>& arguments) {
  std::vector<const char*> argv = {"flinch"};
  for (const std::string& argument : arguments) argv.push_back(argument.c_str());
  ::testing::internal::CaptureStdout();
  ::testing::internal::CaptureStderr();
  Outcome outcome;
  outcome.status = run_command_line(static_cast<int>(argv.size()), argv.data());
  outcome.err = ::testing::internal::GetCapturedStderr();
  outcome.out = ::testing::internal::GetCapturedStdout();
  return outcome;
}

}  // namespace flinch::test
