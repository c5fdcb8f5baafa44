#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

namespace flinch {

/// A sensor at the limit of its range repeats the largest value that it can say. Sets `usable` to 0 for the
/// samples at the largest value of a signal, where at least three of them follow one another and they are
/// more than two in a thousand. Returns how many these are.
std::size_t mark_clipped(const Eigen::VectorXd& signal, std::vector<char>& usable);

/// Sets `usable` to 0 up to `reach` samples before and after each that is not.
void widen_unusable(std::vector<char>& usable, std::ptrdiff_t reach);

}  // namespace flinch
