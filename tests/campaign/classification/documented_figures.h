#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "learning/evaluation.h"

namespace flinch::test {

/// The numbers in the cells of the one row of docs/theory.md that begins with `start`, from the cell after
/// that on. None where there is no such row, or several.
std::vector<double> documented_row(const std::string& start);

/// Between which a share lies that was found by counting.
struct ShareBounds {
  double least = 0.0, most = 1.0;

  /// Whether a share that was printed with one decimal of a percent may be that share.
  bool allow(double percent) const;
};

/// Clopper and Pearson (1934): each bound is passed with a probability of 1/1000.
ShareBounds bounds_of_share(double events, double trials);

/// The same for the mean over the classes that occur of the share that was right. Each class has bounds that
/// are so wide that all of them hold together, and with them their mean.
ShareBounds bounds_of_mean(const Confusion& confusion);

}  // namespace flinch::test
