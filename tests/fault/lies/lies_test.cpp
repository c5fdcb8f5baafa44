#include <fmt/core.h>
#include <gtest/gtest.h>

#include "tests/fault/lies/lie_cases.h"

namespace flinch::test {
namespace {

TEST(Lies, Trial) {
  fmt::print("{}", table_head());
  for (const double speed : {0.0, 0.3, 1.0}) {
    const LieScene scene{.speed = speed};
    const LieRun honest = honest_run(scene);
    for (const std::string& lie : lies_of_a_drive(2)) fmt::print("{}", line_of(try_lie(scene, lie, honest)));
    for (const std::string& lie : lies_of_all()) fmt::print("{}", line_of(try_lie(scene, lie, honest)));
  }
}

}  // namespace
}  // namespace flinch::test
