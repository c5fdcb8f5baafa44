#include "experiments/scenario/scenario_stages.h"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "diagrams/control_stages.h"
#include "systems/config/config_reader.h"
#include "systems/foundation/nearest_name.h"

namespace flinch {
namespace {

/// Keeps of `stages` those with these names, in their order.
template <class S>
void keep(Stages<S>& stages, const std::vector<std::string>& names) {
  std::vector<S> kept;
  for (const std::string& name : names) {
    for (S& stage : stages.all) {
      if (stage.name == name) kept.push_back(stage);
    }
  }
  stages.all = std::move(kept);
}

/// The names of those that run where a file names none.
template <class S>
std::vector<std::string> unasked(const Stages<S>& stages) {
  std::vector<std::string> names;
  for (const S& stage : stages.all) {
    if (!stage.only_when_named) names.push_back(stage.name);
  }
  return names;
}

/// Where a kind of stages stands in the file.
struct Keys {
  const char* list;      ///< in `control`
  const char* followed;  ///< in `control.follow`
};

template <class S>
void read_kind(ConfigReader& control, ConfigReader& follow, const Keys& keys,
               std::vector<std::string> standard, Stages<S>& stages) {
  control.words(keys.list, standard, names_of(stages));
  keep(stages, standard);
  const std::vector<std::string> running = names_of(stages);
  if (running.empty()) return;
  stages.followed = running.front();
  follow.text(keys.followed, stages.followed);
  if (std::find(running.begin(), running.end(), stages.followed) == running.end()) {
    follow.problem(keys.followed, "is '" + stages.followed + "', which is not among " + keys.list +
                                      did_you_mean(stages.followed, running));
  }
}

template <class S>
void read_kind(ConfigReader& control, ConfigReader& follow, const Keys& keys, Stages<S>& stages) {
  if (!stages.all.empty()) read_kind(control, follow, keys, {stages.all.front().name}, stages);
}

}  // namespace

void read_stages(ConfigReader& control, ControlStages& stages) {
  ConfigReader follow = control.section("follow");
  read_kind(control, follow, {"velocities", "velocity"}, stages.velocities);
  if (!stages.accelerations.all.empty())
    read_kind(control, follow, {"accelerations", "acceleration"}, {}, stages.accelerations);
  read_kind(control, follow, {"estimators", "estimator"}, stages.estimators);
  read_kind(control, follow, {"detectors", "detector"}, stages.detectors);
  read_kind(control, follow, {"classifiers", "classifier"}, unasked(stages.classifiers), stages.classifiers);
  read_kind(control, follow, {"locators", "locator"}, unasked(stages.locators), stages.locators);
  read_kind(control, follow, {"nominal_laws", "nominal_law"}, stages.nominal_laws);
  read_kind(control, follow, {"reaction_laws", "reaction_law"}, stages.reaction_laws);
}

}  // namespace flinch
