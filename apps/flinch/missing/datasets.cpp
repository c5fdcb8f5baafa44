// What stands in for 'flinch dataset' in a program that was built without the simulation, dlib or ONNX.
#include "apps/flinch/learning_verbs.h"
#include "systems/foundation/setup_error.h"

namespace flinch {

namespace {

[[noreturn]] void refuse(const std::filesystem::path& spec) {
  throw SetupError(spec.string() +
                   ": no data can be made of it, for this flinch was built without the simulation, dlib or "
                   "ONNX");
}

}  // namespace

std::vector<CalibrationWarning> check_data_spec(const std::filesystem::path& spec) { refuse(spec); }
ExitStatus dataset(const DatasetOptions& options) { refuse(options.spec); }

}  // namespace flinch
