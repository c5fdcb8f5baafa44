#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

#include "systems/contact/contact_locator.h"
#include "systems/contact/decision_tree.h"
#include "systems/contact/feature_extraction.h"
#include "systems/contact/link_particles.h"
#include "systems/contact/model_classifier.h"
#include "systems/contact/touch_hypotheses.h"
#include "systems/contact/touch_pairs_settings.h"
#include "systems/contact/wrench_uncertainty.h"

namespace flinch {

/// Networks of the classifier "papers_networks", as ONNX files; empty: those that come with flinch.
struct PapersNetworkFiles {
  std::filesystem::path clamping;  ///< of the question 'clamping'
  std::filesystem::path chain;     ///< of the question 'chain'
  std::filesystem::path body;      ///< of the question 'body'
  double accept = 0.0;             ///< least probability to act upon; the papers act on the most likely class
};

/// Force sensors below the base joints, with which two contacts at once can be located.
struct BaseForceSettings {
  JointVector first_moment{};  ///< Of each leg's links, m1 s1 + m2 l1 [kg m].
  TouchPairsSettings pairs{};
  Time period = 5ms;  ///< After which contacts are located anew.
};

/// What can be set of how a contact is classified and located.
struct IsolationSettings {
  /// Of the momentum observer that it reads, for every coordinate alike: at the detection tick of one with 20
  /// 1/s that one still estimates a small part of the force [1/s].
  double observer_gain = 100.0;
  /// Of that observer, measured on the realistic rig, as are the frequencies below.
  WrenchUncertainty uncertainty{
      .force = 1.5, .moment = 0.12, .share_of_force = 0.02, .share_of_lever = 0.002};
  Time same_contact = 100ms;  ///< for so long a contact that has gone may come back as the same

  FeatureSettings features;
  /// Biases are those of the planar rig; settings_for() has none for robots in space.
  TouchHypothesesSettings hypotheses{.object_speed = 0.2,
                                     .object_radius = 0.04,
                                     .softness = 0.005,
                                     .closing_speed = 0.05,
                                     .friction = 0.1,
                                     .platform_bias = 0.65,
                                     .link1_bias = -1.3,
                                     .clamping_bias = -1.05};
  ModelClassifierSettings model_classifier;
  DecisionTreeSettings decision_tree;
  PapersNetworkFiles papers_networks;
  /// ONNX file of "learned_classifier"; empty: that which comes with flinch.
  std::filesystem::path learned_network;
  ContactLocatorSettings closed_form;
  LinkParticleSettings particle_filter;
  std::uint64_t particle_seed = 1;
  std::optional<BaseForceSettings> base_forces{};  ///< none: there are no such sensors
};

}  // namespace flinch
