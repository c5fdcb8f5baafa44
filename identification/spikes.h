#pragma once

#include <Eigen/Core>
#include <cstddef>

namespace flinch {

/// Draws a straight line between its good neighbours in the place of each sample that is farther than five
/// deviations from the median of its neighbourhood, `reach` samples to either side. The deviations are told
/// by the median distance, in the neighbourhood and in the whole signal (Hampel). Columns are signals.
/// Returns how many samples that were.
std::size_t remove_spikes(Eigen::MatrixXd& signals, int reach = 3);

}  // namespace flinch
