// Models of robots from elsewhere: URDF, SDF, MJCF.
#include "tests/convert/converted_models.h"
#include "tests/fuzz/fuzz_target.h"

namespace flinch::test {
namespace {

void try_model(std::string_view bytes) {
  BodyGraph graph = read_model(bytes, "fuzzed.xml");
  if (graph.bodies.size() > 20) return;  // what large ones cost, they ask for
  const std::string platform = graph.bodies.back().name;
  try {
    converted_robot(std::move(graph), {.platform = platform});
  } catch (const SetupError&) {  // most make no robot
  }
}

std::vector<std::string> model_seeds() {
  return {model_text("five_bar.urdf"), model_text("five_bar.sdf"), model_text("two_rods.xml")};
}

}  // namespace

const FuzzTarget model_target{"model", try_model, model_seeds};

}  // namespace flinch::test
