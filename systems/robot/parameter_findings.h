#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "systems/robot/joint_friction.h"

namespace flinch {

/// Collects what is wrong with a robot's parameters: sentences "field is value unit; expectation".
class ParameterFindings {
 public:
  void positive(const std::string& field, double value, const char* unit);
  void not_negative(const std::string& field, double value, const char* unit);
  void finite(const std::string& field, double value, const char* unit);
  /// Every entry, as field[0], field[1], ...
  void finite(const std::string& field, const Eigen::Ref<const Eigen::VectorXd>& values, const char* unit);
  /// Neither part of a turning joint's friction may be negative.
  void friction(const std::string& field, const JointFriction& friction);
  /// The same for a sliding joint.
  void sliding_friction(const std::string& field, const JointFriction& friction);

  void add(const std::string& field, double value, const char* unit, const char* expectation);
  void add(std::string sentence) { sentences_.push_back(std::move(sentence)); }

  bool none() const { return sentences_.empty(); }
  std::vector<std::string> take() { return std::move(sentences_); }

 private:
  std::vector<std::string> sentences_;
};

}  // namespace flinch
