// What stands in for the verbs that learn in a program that was built without dlib or ONNX.
#include "apps/flinch/learning_verbs.h"
#include "systems/foundation/setup_error.h"

namespace flinch {
namespace {

[[noreturn]] ExitStatus refuse(const std::string& verb) {
  throw SetupError("flinch " + verb +
                   ": this flinch was built without dlib or ONNX; install libdlib-dev, libonnx-dev and "
                   "libprotobuf-dev, and build it anew");
}

}  // namespace

ExitStatus train(const TrainOptions&) { refuse("train"); }
ExitStatus evaluate(const EvaluateOptions&) { refuse("evaluate"); }
void check_classifier(const std::filesystem::path&) { refuse("check"); }
void check_data_set(const std::filesystem::path&) { refuse("check"); }
void follow_classifier(const std::filesystem::path&, Scenario&) { refuse("run --classifier"); }

}  // namespace flinch
