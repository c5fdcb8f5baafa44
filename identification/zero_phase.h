#pragma once

#include <Eigen/Core>

namespace flinch {

/// A low pass that delays nothing, since it knows the future: a Butterworth filter of second order, run
/// forwards and backwards. At the cut-off frequency a half of the amplitude is left. Columns are signals,
/// rows samples, `period` apart [s]; the ends are continued by point reflection.
Eigen::MatrixXd zero_phase(const Eigen::MatrixXd& samples, double cutoff_frequency, double period);

}  // namespace flinch
