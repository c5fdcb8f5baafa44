#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace flinch {

/// An axis that is not itself.
struct SwappedAxis {
  std::string name;  ///< "x"
  std::string is;    ///< which axis it is, "-y"
};

/// The axes that a matrix, nearly a signed permutation, takes for others: of each row the largest entry.
std::vector<SwappedAxis> swapped_axes(const Eigen::Matrix3d& axes);

}  // namespace flinch
