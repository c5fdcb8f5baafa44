#pragma once

#include "experiments/report/report.h"

namespace flinch {

/// A fabricated experiment to develop and test the page with: test data, not a result of flinch. The geometry
/// is that of the planar 3-RRR rig. The platform moves as a decoupled mass under impedance control, runs
/// into a pylon at about 0.93 m/s and is taken back. Deterministic.
Report sample_report();

}  // namespace flinch
