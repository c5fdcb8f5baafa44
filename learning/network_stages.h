#pragma once

#include <filesystem>
#include <functional>
#include <vector>

#include "diagrams/control_stages.h"

namespace flinch {

struct Scenario;

/// The classifiers that ask networks in files, for add_known_classifier(): "papers_networks", which asks
/// those of `control.isolation.papers_networks`, and "learned_classifier", which asks that of
/// `control.isolation.learned_classifier`. Where a scenario names no file, that in `shipped` is taken:
/// papers_clamping.onnx, papers_chain.onnx, papers_body.onnx, bodies.onnx. A control path that has one of
/// them throws SetupError where its networks cannot be read, or are for another robot.
std::vector<ContactClassifier> network_stages(const std::filesystem::path& shipped);

/// What lets the control path of scenarios follow the classifier of `files`: one of the question `touched`,
/// or the three of the papers in any order. Throws SetupError where one cannot be read or they do not make
/// one classifier; the function, which threads may share, where they are not for the robot of the scenario.
std::function<void(Scenario&)> follow_networks(const std::vector<std::filesystem::path>& files);

}  // namespace flinch
