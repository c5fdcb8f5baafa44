#pragma once

#include <memory>
#include <string>
#include <vector>

#include "learning/classifier_model.h"
#include "learning/feature_set.h"

namespace flinch {

/// What can be checked without a robot: throws SetupError where a model of the question `touched` was trained
/// with other features than this version's.
void check_features(const ClassifierModel& model);

/// What the metadata of a model say that it answers. Throws SetupError where they do not.
Question question_of(const ClassifierModel& model);

/// How the questions of a model are asked about a data set. Throws SetupError where they cannot be: about
/// another robot or by features of another version, which is all that is told then; or else with all features
/// and classes that are others.
FeatureSet features_for(const ClassifierModel& model, const DataSet& data);

/// Throws SetupError where the model cannot be asked about contacts of the robot: it was trained for one of
/// another geometry, or by features of another version, or has other features and classes.
void require_features(const ClassifierModel& model, const std::shared_ptr<const ParallelRobot>& robot);

/// One sentence where the model has learned from the data, or from data of the same title and seed, of which
/// the smaller are part of the larger, and in one of the `configurations` (empty: all); "" otherwise, and
/// where the model does not say.
std::string warning_of_learned(const ClassifierModel& model, const DataSet& data,
                               const std::vector<int>& configurations);

}  // namespace flinch
