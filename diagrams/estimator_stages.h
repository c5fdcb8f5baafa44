#pragma once

#include <vector>

#include "diagrams/control_stages.h"

namespace flinch {

/// Every wrench estimator of flinch, as its settings say, by the name of its section of them. The first is
/// the standard one.
std::vector<WrenchEstimator> estimator_stages();

/// The estimator "imu_residual" where the motion without a lag is known, with the model there: `present`.
OutputPort<WrenchEstimate> add_imu_residual(const StageContext& site, const AcceleratedPorts& given,
                                            const AcceleratedPorts& present);

}  // namespace flinch
