// Robot files.
#include "systems/config/robot_file.h"
#include "tests/fuzz/fuzz_files.h"
#include "tests/fuzz/fuzz_target.h"

namespace flinch::test {
namespace {

void try_robot(std::string_view bytes) { parse_robot_file(bytes, "fuzzed.yaml"); }

std::vector<std::string> robot_seeds() { return shipped_files("robots", ".yaml"); }

}  // namespace

const FuzzTarget robot_target{"robot", try_robot, robot_seeds};

}  // namespace flinch::test
