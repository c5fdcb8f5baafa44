// What lets scenarios and --classifier name networks, where the program can read them.
#include "apps/flinch/learning_verbs.h"
#include "apps/flinch/shipped_files.h"
#include "learning/network_stages.h"

namespace flinch {

std::function<void(Scenario&)> classifier_of(const std::vector<std::filesystem::path>& models) {
  return follow_networks(models);
}

void add_network_stages() {
  for (ContactClassifier& stage : network_stages(shipped_folder() / "models"))
    add_known_classifier(std::move(stage));
}

}  // namespace flinch
