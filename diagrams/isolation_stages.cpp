#include "diagrams/isolation_stages.h"

#include <utility>

#include "diagrams/contact_control_settings.h"
#include "systems/contact/contact_period.h"
#include "systems/contact/contact_window_buffer.h"
#include "systems/contact/evidence_estimator.h"
#include "systems/contact/particle_locator.h"
#include "systems/contact/wrench_trend.h"
#include "systems/foundation/setup_error.h"
#include "systems/framework/random.h"

namespace flinch {
namespace {

OutputPort<ContactClassification> add_model_classifier(const StageContext& site, const ContactPorts& given) {
  auto& classifier =
      site.builder.add<ModelClassifier>(site.name, site.robot, site.settings.isolation.model_classifier);
  site.builder.connect(given.contact, classifier.phase);
  site.builder.connect(given.evidence, classifier.evidence);
  return classifier.classification;
}

OutputPort<ContactClassification> add_decision_tree(const StageContext& site, const ContactPorts& given) {
  auto& tree = site.builder.add<DecisionTree>(site.name, site.robot, site.settings.isolation.decision_tree);
  site.builder.connect(given.contact, tree.phase);
  site.builder.connect(given.features, tree.features);
  site.builder.connect(given.kinematics, tree.kinematics);
  return tree.classification;
}

template <class Locator>
void connect_locator(const StageContext& site, const ClassifiedPorts& given, Locator& locator) {
  site.builder.connect(given.contact, locator.phase);
  site.builder.connect(given.classification, locator.classification);
  site.builder.connect(given.kinematics, locator.kinematics);
  site.builder.connect(given.isolation_wrench, locator.wrench);
  site.builder.connect(given.isolation_change, locator.change);
}

LocatorPorts add_closed_form(const StageContext& site, const ClassifiedPorts& given) {
  const IsolationSettings& settings = site.settings.isolation;
  auto& locator =
      site.builder.add<ContactLocator>(site.name, site.robot, settings.closed_form, settings.uncertainty);
  connect_locator(site, given, locator);
  return {.location = locator.location};
}

LocatorPorts add_particle_filter(const StageContext& site, const ClassifiedPorts& given) {
  const IsolationSettings& settings = site.settings.isolation;
  auto& locator =
      site.builder.add<ParticleLocator>(site.name, site.robot, settings.particle_filter, settings.closed_form,
                                        settings.uncertainty, derive_seed(settings.particle_seed, site.name));
  connect_locator(site, given, locator);
  return {.location = locator.location, .cloud = locator.cloud};
}

MomentumObserver& add_observer(const StageContext& site, const EstimatePorts& given) {
  MomentumObserverSettings settings = site.settings.momentum_observer;
  if (!(site.settings.isolation.observer_gain > 0.0)) {
    throw SetupError("isolation: observer_gain must be positive [1/s]");
  }
  settings.gain = PlatformVector::Constant(site.robot->dof(), site.settings.isolation.observer_gain);
  auto& observer = site.builder.add<MomentumObserver>("isolation_observer", site.robot, settings);
  site.builder.connect(given.platform, observer.platform);
  site.builder.connect(given.kinematics, observer.kinematics);
  site.builder.connect(given.dynamics, observer.dynamics);
  site.builder.connect(given.drive_torque, observer.torque);
  return observer;
}

}  // namespace

std::vector<ContactClassifier> classifier_stages() {
  return {{"model_classifier", add_model_classifier}, {"decision_tree", add_decision_tree}};
}

ContactClassifier learned_classifier_stage(LearnedClassifierSettings settings) {
  return {"learned_classifier",
          [settings = std::move(settings)](const StageContext& site, const ContactPorts& given) {
            DiagramBuilder& builder = site.builder;
            auto& classifier = builder.add<LearnedClassifier>(site.name, site.robot, settings);
            auto& course = builder.add<ContactWindowBuffer>(site.name + "_course", settings.window,
                                                            site.settings.control_period);
            // The evidence that it was trained with, whatever the model classifier is told.
            const auto evidence_of = [&](const std::string& name, OutputPort<WrenchEstimate> wrench) {
              auto& evidence =
                  builder.add<EvidenceEstimator>(site.name + name, site.robot, TouchHypothesesSettings(),
                                                 WrenchUncertainty(), settings.window);
              builder.connect(given.contact, evidence.phase);
              builder.connect(given.kinematics, evidence.kinematics);
              builder.connect(wrench, evidence.wrench);
              return evidence.evidence;
            };
            builder.connect(given.contact, classifier.phase);
            builder.connect(given.kinematics, classifier.kinematics);
            builder.connect(given.contact, course.phase);
            builder.connect(given.isolation_wrench, course.wrench);
            builder.connect(given.platform, course.platform);
            builder.connect(course.course, classifier.course);
            builder.connect(evidence_of("_evidence", given.isolation_wrench), classifier.evidence);
            builder.connect(evidence_of("_growth_evidence", course.growth), classifier.growth_evidence);
            return classifier.classification;
          }};
}

ContactClassifier papers_networks_stage(PapersClassifierSettings settings) {
  return {"papers_networks",
          [settings = std::move(settings)](const StageContext& site, const ContactPorts& given) {
            auto& classifier = site.builder.add<PapersClassifier>(site.name, site.robot, settings);
            site.builder.connect(given.contact, classifier.phase);
            site.builder.connect(given.features, classifier.features);
            return classifier.classification;
          }};
}

std::vector<ContactLocatorStage> locator_stages() {
  return {{"closed_form", add_closed_form}, {"particle_filter", add_particle_filter}};
}

ContactPorts add_isolation(const StageContext& site, const EstimatePorts& given,
                           OutputPort<ContactDetection> detection) {
  DiagramBuilder& builder = site.builder;
  const IsolationSettings& settings = site.settings.isolation;
  auto& period = builder.add<ContactPeriod>("contact_period", settings.same_contact);
  auto& observer = add_observer(site, given);
  auto& features = builder.add<FeatureExtraction>("contact_features", site.robot, settings.features);
  auto& evidence = builder.add<EvidenceEstimator>("contact_evidence", site.robot, settings.hypotheses,
                                                  settings.uncertainty, settings.model_classifier.window);
  builder.connect(detection, period.detection);
  builder.connect(given.reset, period.reset);
  builder.connect(given.kinematics, features.kinematics);
  builder.connect(observer.wrench, features.wrench);
  auto& trend = builder.add<WrenchTrend>("isolation_trend", from_seconds(1.0 / settings.observer_gain));
  builder.connect(observer.wrench, trend.wrench);
  builder.connect(period.phase, evidence.phase);
  builder.connect(given.kinematics, evidence.kinematics);
  builder.connect(observer.wrench, evidence.wrench);
  return {given,        detection,         period.phase,     observer.wrench,
          trend.change, features.features, evidence.evidence};
}

}  // namespace flinch
