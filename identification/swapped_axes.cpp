#include "identification/swapped_axes.h"

namespace flinch {

std::vector<SwappedAxis> swapped_axes(const Eigen::Matrix3d& axes) {
  static constexpr const char* names[] = {"x", "y", "z"};
  std::vector<SwappedAxis> swapped;
  for (int i = 0; i < 3; ++i) {
    Eigen::Index from = 0;
    axes.row(i).cwiseAbs().maxCoeff(&from);
    const std::string is = (axes(i, from) < 0.0 ? "-" : "") + std::string(names[from]);
    if (is != names[i]) swapped.push_back({names[i], is});
  }
  return swapped;
}

}  // namespace flinch
