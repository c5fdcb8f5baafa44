#pragma once

#include "learning/classifier_model.h"
#include "learning/feature_set.h"

namespace flinch {

/// What can be checked without a robot: throws SetupError where a model of the question `touched` was trained
/// with other features than this version's.
void check_features(const ClassifierModel& model);

/// How the questions of a model are asked about a data set. Throws SetupError with all that speaks against
/// it: another robot, features in another order, other classes.
FeatureSet features_for(const ClassifierModel& model, const DataSet& data);

}  // namespace flinch
