#pragma once

#include "systems/robot/planar_rrr_parameters.h"

/// The 3-RRR test rig of [SafePR], [ICRA23] and [RAL25].
namespace flinch {

enum class RigGeometry {
  individual,  ///< Each leg as measured.
  nominal      ///< Equal legs, 120 degrees apart.
};

enum class RigFriction {
  none,
  test_rig,   ///< Identified: mostly Coulomb friction of the drives.
  simulation  ///< 1 Nm s/rad in each drive.
};

/// The rig with its published base parameters, equal for all legs.
PlanarRrrParameters rig_robot(RigGeometry geometry, RigFriction friction);

/// The published first and second link as bodies; `base_parameters` with nominal lengths gives the base
/// parameters of `rig_robot`.
LinkBody rig_link1();
LinkBody rig_link2();

}  // namespace flinch
