#pragma once

#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "systems/framework/diagram_builder.h"
#include "systems/robot/parallel_robot.h"
#include "systems/signals/drive_load.h"

namespace flinch {

struct ContactControlSettings;
struct SharedParts;

/// An output of the stage called `name`.
template <class Port>
struct Named {
  std::string name;
  Port port;
};

/// Where a stage is added.
struct StageContext {
  DiagramBuilder& builder;  ///< of the control path
  std::string name;         ///< of the stage, for its block; of further blocks: name + "_" + what they are
  std::shared_ptr<const ParallelRobot> robot;
  const ContactControlSettings& settings;
  SharedParts& shared;  ///< of the control path
  /// Takes the loads of the drives that a detector of this site judges by, to be recorded; null: nobody does.
  std::vector<Named<OutputPort<DriveLoad>>>* loads = nullptr;
};

/// A part of the control path that can be exchanged: its name, and the function that adds its blocks to
/// `site.builder`, connects them with those of `given` that they read, and returns the ports that they offer.
/// The function may throw SetupError. It is called once for every control path that is built.
template <class Given, class Offered>
struct Stage {
  using Add = std::function<Offered(const StageContext& site, const Given& given)>;

  std::string name;  ///< letters, digits and '_'
  Add add;
  bool only_when_named = false;  ///< whether it is left out where a scenario names no stages of its kind
};

/// Stages of one kind, side by side: all of them run, one of them is followed by what comes after it.
template <class S>
struct Stages {
  std::vector<S> all;
  std::string followed;  ///< its name; empty: the first

  /// Lets `stage` run beside the others.
  void add(S stage) { all.push_back(std::move(stage)); }
  /// Lets `stage` run beside the others and follows it.
  void follow(S stage) {
    followed = stage.name;
    add(std::move(stage));
  }
};

/// The name of the stage that is followed; "" where there is none.
template <class S>
std::string followed_name(const Stages<S>& stages) {
  if (!stages.followed.empty() || stages.all.empty()) return stages.followed;
  return stages.all.front().name;
}

template <class S>
std::vector<std::string> names_of(const Stages<S>& stages) {
  std::vector<std::string> names;
  for (const S& stage : stages.all) names.push_back(stage.name);
  return names;
}

}  // namespace flinch
