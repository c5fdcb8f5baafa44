#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "experiments/report/page_samples.h"
#include "systems/robot/configuration_space.h"

namespace flinch {

inline const double no_value = std::nan("");
inline constexpr std::array page_axes{"x", "y", "z"};

/// A vector of the page: one column a component, all of the sample whose `weight` is greatest.
class VectorColumns {
 public:
  VectorColumns(PageSamples& page, const std::vector<std::string>& names) : page_(page) {
    for (const std::string& name : names) columns_.push_back(page.column(name));
  }
  void set(const auto& vector, double weight) {
    const bool fits = vector.size() == static_cast<Eigen::Index>(columns_.size());
    for (std::size_t i = 0; i < columns_.size(); ++i) {
      page_.set(columns_[i], fits ? vector[static_cast<Eigen::Index>(i)] : no_value,
                fits ? weight : no_value);
    }
  }
  void set_no_data() { set(Eigen::Matrix<double, 0, 1>(), 0.0); }

 private:
  PageSamples& page_;
  std::vector<std::size_t> columns_;
};

/// prefix + "x", prefix + "y", ...
inline std::vector<std::string> named(const std::string& prefix, int count) {
  std::vector<std::string> names;
  for (int i = 0; i < count; ++i) names.push_back(prefix + page_axes[static_cast<std::size_t>(i)]);
  return names;
}

/// prefix + "1", prefix + "2", ...
inline std::vector<std::string> numbered(const std::string& prefix, int count) {
  std::vector<std::string> names;
  for (int i = 0; i < count; ++i) names.push_back(prefix + std::to_string(i + 1));
  return names;
}

inline std::vector<std::string> pose_names(const ConfigurationSpace& space) {
  std::vector<std::string> names = named("pose_", space.translations());
  if (space.rotations() == 1) names.emplace_back("pose_phi");
  if (space.rotations() == 3) names.insert(names.end(), {"pose_qw", "pose_qx", "pose_qy", "pose_qz"});
  return names;
}

inline std::vector<std::string> wrench_names(const std::string& name, const ConfigurationSpace& space) {
  std::vector<std::string> names = named(name + "_force_", space.translations());
  if (space.rotations() == 1) names.push_back(name + "_moment");
  if (space.rotations() == 3) {
    for (const std::string& moment : named(name + "_moment_", 3)) names.push_back(moment);
  }
  return names;
}

}  // namespace flinch
