#pragma once

#include "systems/robot/planar_rrr_parameters.h"

/// The 3-RRR test bench of [SafePR], [ICRA23] and [RAL25].
namespace flinch {

enum class BenchGeometry {
  individual,  ///< Each leg as measured.
  nominal      ///< Equal legs, 120 degrees apart.
};

enum class BenchFriction {
  none,
  test_bench,  ///< Identified: mostly Coulomb friction of the drives.
  simulation   ///< 1 Nm s/rad in each drive.
};

/// The bench with its published base parameters, equal for all legs.
PlanarRrrParameters bench_robot(BenchGeometry geometry, BenchFriction friction);

/// The published first and second link as bodies; `base_parameters` with nominal lengths gives the base
/// parameters of `bench_robot`.
LinkBody bench_link1();
LinkBody bench_link2();

}  // namespace flinch
