// What stands in for the verbs that learn in a program that was built without dlib or ONNX.
#include "apps/flinch/learning_verbs.h"
#include "diagrams/control_stages.h"
#include "systems/foundation/setup_error.h"

namespace flinch {
namespace {

[[noreturn]] void refuse(const std::string& what) {
  throw SetupError(what +
                   ": this flinch was built without dlib or ONNX; install libdlib-dev, libonnx-dev and "
                   "libprotobuf-dev, and build it anew");
}

}  // namespace

ExitStatus train(const TrainOptions&) { refuse("flinch train"); }
ExitStatus evaluate(const EvaluateOptions&) { refuse("flinch evaluate"); }
void check_classifier(const std::filesystem::path& model) { refuse(model.string()); }
void check_data_set(const std::filesystem::path& data) { refuse(data.string()); }
std::function<void(Scenario&)> classifier_of(const std::vector<std::filesystem::path>&) {
  refuse("--classifier");
}

void add_network_stages() {
  for (const char* const name : {"papers_networks", "learned_classifier"}) {
    const auto add = [name](const StageContext&, const ContactPorts&) -> OutputPort<ContactClassification> {
      refuse(name);
    };
    add_known_classifier({name, add, true});
  }
}

}  // namespace flinch
