// What stands in for 'flinch dataset' in a program that was built without the simulation, dlib or ONNX.
#include "apps/flinch/learning_verbs.h"
#include "systems/foundation/setup_error.h"

namespace flinch {

ExitStatus dataset(const DatasetOptions& options) {
  throw SetupError(options.spec.string() +
                   ": no data can be made of it, for this flinch was built without the simulation, dlib or "
                   "ONNX");
}

}  // namespace flinch
