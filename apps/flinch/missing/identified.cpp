// What stands in for the calibrations of a program that was built without Ceres.
#include "apps/flinch/command_line.h"
#include "systems/foundation/setup_error.h"

namespace flinch {
namespace {

[[noreturn]] void refuse(const char* what) {
  throw SetupError(
      std::string("flinch ") + what +
      ": this flinch was built without Ceres (Debian: libceres-dev); install it and build again");
}

}  // namespace

ExitStatus calibrate_torque_constant(const CalibrateOptions&) { refuse("calibrate torque-constant"); }
ExitStatus calibrate_imu_pose(const CalibrateOptions&) { refuse("calibrate imu-pose"); }
ExitStatus calibrate_dynamics(const CalibrateOptions&) { refuse("calibrate dynamics"); }
ExitStatus calibrate_all(const CalibrateAllOptions&) { refuse("calibrate all"); }
ExitStatus excite(const ExciteOptions&) { refuse("excite"); }

}  // namespace flinch
