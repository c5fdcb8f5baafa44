#include "diagrams/control_stages.h"

#include <algorithm>
#include <set>
#include <string>
#include <utility>

#include "diagrams/acceleration_stages.h"
#include "diagrams/contact_control_settings.h"
#include "diagrams/estimator_stages.h"
#include "diagrams/fused_detector.h"
#include "diagrams/isolation_stages.h"
#include "diagrams/task_stages.h"
#include "systems/foundation/nearest_name.h"
#include "systems/foundation/setup_error.h"

namespace flinch {
namespace {

OutputPort<JointMotion> add_velocity_filter(const StageContext& site, const SensedPorts& given) {
  auto& filter = site.builder.add<VelocityFilter>(site.name, site.robot, site.settings.velocity_filter);
  site.builder.connect(given.joints, filter.joints);
  return filter.motion;
}

OutputPort<ContactDetection> add_contact_detector(const StageContext& site, const EstimatePorts& given) {
  const std::string estimator = followed_name(site.settings.stages.estimators);
  auto& detector =
      site.builder.add<ContactDetector>(site.name, site.robot, site.settings.detector_of(estimator));
  site.builder.connect(given.wrench, detector.wrench);
  site.builder.connect(given.reset, detector.reset);
  return detector.contact;
}

LawPorts add_impedance(const StageContext& site, const std::string& name, const ImpedanceSettings& settings,
                       const MotionPorts& given, OutputPort<PlatformReference> reference) {
  auto& impedance = site.builder.add<ImpedanceController>(name, site.robot, settings);
  site.builder.connect(given.kinematics, impedance.kinematics);
  site.builder.connect(given.dynamics, impedance.dynamics);
  site.builder.connect(reference, impedance.reference);
  return {.torque = impedance.torque, .reference = reference};
}

LawPorts add_nominal_impedance(const StageContext& site, const ReactionPorts& given) {
  return add_impedance(site, site.name, site.settings.impedance, given, given.nominal);
}

ImpedanceSettings softened(const ImpedanceSettings& nominal, double share, const ConfigurationSpace& space) {
  if (!(share >= 0.0 && share <= 1.0)) throw SetupError("reaction_stiffness must be between 0 and 1");
  ImpedanceSettings settings = complete(nominal, space);
  const int translations = space.translations();
  if (settings.stiffness.size() >= translations) settings.stiffness.head(translations) *= share;
  return settings;
}

LawPorts add_retraction(const StageContext& site, const ReactionPorts& given) {
  auto& retraction = site.builder.add<Retraction>(site.name, site.robot, site.settings.retraction);
  site.builder.connect(given.reaction, retraction.reaction);
  site.builder.connect(given.platform, retraction.platform);
  site.builder.connect(given.wrench, retraction.estimate);
  const ImpedanceSettings soft =
      softened(site.settings.impedance, site.settings.reaction_stiffness, site.robot->space());
  return add_impedance(site, site.name + "_impedance", soft, given, retraction.reference);
}

/// Stands for a classifier that asks networks until a program adds it: files that name it can be read.
ContactClassifier without_networks(const std::string& name) {
  const auto refuse = [name](const StageContext&, const ContactPorts&) -> OutputPort<ContactClassification> {
    throw SetupError("the classifier '" + name +
                     "' asks networks, of which this program knows none; it must hand those of "
                     "network_stages() to add_known_classifier() first");
  };
  return {name, refuse, true};
}

std::vector<ContactClassifier>& added_classifiers() {
  static std::vector<ContactClassifier> added = {without_networks("papers_networks"),
                                                 without_networks("learned_classifier")};
  return added;
}

bool is_word(const std::string& name) {
  const auto allowed = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
  };
  return !name.empty() && std::all_of(name.begin(), name.end(), allowed);
}

template <class S>
void find_problems(const Stages<S>& stages, const std::string& kind, std::vector<std::string>& problems) {
  std::vector<std::string> names;
  for (const S& stage : stages.all) {
    if (!is_word(stage.name)) {
      problems.push_back("the name '" + stage.name + "' of a " + kind +
                         " must consist of letters, digits and '_'");
    }
    if (!stage.add) problems.push_back("the " + kind + " '" + stage.name + "' has no function that adds it");
    names.push_back(stage.name);
  }
  if (std::set(names.begin(), names.end()).size() != names.size()) {
    problems.push_back("two " + kind + "s have the same name");
  }
  const bool known = std::find(names.begin(), names.end(), stages.followed) != names.end();
  if (!stages.followed.empty() && !known) {
    problems.push_back("the " + kind + " to follow is '" + stages.followed + "', which does not run" +
                       did_you_mean(stages.followed, names));
  }
}

template <class S>
void require(const Stages<S>& stages, const std::string& kind, std::vector<std::string>& problems) {
  if (stages.all.empty()) problems.push_back("there must be a " + kind);
}

}  // namespace

ControlStages standard_stages() {
  return {.velocities = {.all = {{"velocity_filter", add_velocity_filter}}, .followed = ""},
          .accelerations = {},
          .estimators = {.all = {estimator_stages().front()}, .followed = ""},
          .detectors = {.all = {{"contact_detector", add_contact_detector}}, .followed = ""},
          .classifiers = {.all = {classifier_stages().front()}, .followed = ""},
          .locators = {.all = {locator_stages().front()}, .followed = ""},
          .nominal_laws = {.all = {{"nominal_impedance", add_nominal_impedance}}, .followed = ""},
          .reaction_laws = {.all = {{"retraction", add_retraction}}, .followed = ""}};
}

ControlStages known_stages() {
  ControlStages stages = standard_stages();
  stages.accelerations.all = acceleration_stages();
  stages.estimators.all = estimator_stages();
  stages.classifiers.all = classifier_stages();
  stages.locators.all = locator_stages();
  for (ControlLaw& law : tracking_stages()) stages.nominal_laws.add(std::move(law));
  for (ControlLaw& law : task_reaction_stages()) stages.reaction_laws.add(std::move(law));
  stages.detectors.all.push_back({"fused_detector", add_fused_detector});
  for (const ContactClassifier& classifier : added_classifiers()) stages.classifiers.add(classifier);
  return stages;
}

void add_known_classifier(ContactClassifier classifier) {
  std::vector<ContactClassifier>& added = added_classifiers();
  std::erase_if(added, [&](const ContactClassifier& other) { return other.name == classifier.name; });
  added.push_back(std::move(classifier));
}

std::vector<std::string> problems(const ControlStages& stages) {
  std::vector<std::string> found;
  require(stages.velocities, "velocity source", found);
  require(stages.estimators, "wrench estimator", found);
  require(stages.detectors, "detector", found);
  require(stages.classifiers, "classifier", found);
  require(stages.locators, "locator", found);
  require(stages.nominal_laws, "nominal law", found);
  require(stages.reaction_laws, "reaction law", found);
  find_problems(stages.velocities, "velocity source", found);
  find_problems(stages.accelerations, "acceleration source", found);
  find_problems(stages.estimators, "wrench estimator", found);
  find_problems(stages.detectors, "detector", found);
  find_problems(stages.classifiers, "classifier", found);
  find_problems(stages.locators, "locator", found);
  find_problems(stages.nominal_laws, "nominal law", found);
  find_problems(stages.reaction_laws, "reaction law", found);
  return found;
}

}  // namespace flinch
