#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "plant/plant_truth.h"
#include "plant/rope_pull.h"
#include "plant/sensor_noise.h"
#include "systems/framework/system.h"
#include "systems/robot/mechanism.h"
#include "systems/signals/force_torque_reading.h"
#include "systems/signals/instrument_mounting.h"

namespace flinch {

/// A force-torque instrument that is mounted on one body of the robot after the other, with a rope tied to
/// it.
struct SimulatedInstrumentSettings {
  bool ideal = false;                         ///< Readings are the truth.
  std::vector<InstrumentMounting> mountings;  ///< In the order of their starts; empty: there is none.
  double force_noise = 0.05;                  ///< Standard deviation of white noise [N]; assumed.
  double moment_noise = 0.002;                ///< [Nm]; assumed.
  double misalignment = 0.0;  ///< Each mounting is turned by at most this about each axis [rad].
  double zero_offset = 0.0;   ///< Each component of the force is off by at most this, constantly [N].
};

/// All that is wrong with `settings` for the bodies of `robot`.
std::vector<std::string> problems(const SimulatedInstrumentSettings& settings, const Mechanism& robot);

/// Measures the pull of the rope. The reading is told in the base frame, to which whoever reads the
/// instrument turns it with the angles at which it believes the instrument to sit; so a mounting that is
/// turned tells forces that are.
class SimulatedInstrument final : public System {
 public:
  /// Throws SetupError.
  SimulatedInstrument(const SimulatedInstrumentSettings& settings, std::vector<RopePull> pulls,
                      std::shared_ptr<const Mechanism> robot, std::uint64_t seed);

  /// By which rotation vector, in the axes of its body, each mounting is turned [rad].
  const std::vector<Eigen::Vector3d>& misalignments() const { return misalignments_; }

 private:
  SimulatedInstrumentSettings settings_;
  std::vector<RopePull> pulls_;
  std::shared_ptr<const Mechanism> robot_;
  std::vector<Eigen::Vector3d> misalignments_;
  Eigen::Vector3d zero_offset_;  ///< In the instrument's axes.
  State<NormalNumbers<6>> noise_;

 public:
  InputPort<PlantTruth> truth = input<PlantTruth>("truth");
  OutputPort<ForceTorqueReading> force_torque =
      output<&SimulatedInstrument::measure>("force_torque", clock, truth, noise_);

 private:
  Update draw_ = update<&SimulatedInstrument::draw>(noise_);

  void measure(Time now, const PlantTruth& robot, const NormalNumbers<6>& noise,
               ForceTorqueReading& reading) const;
  void draw(NormalNumbers<6>& noise) const { noise.draw(); }
  Eigen::Matrix3d axes_of(int body, const PlantTruth& robot) const;
};

}  // namespace flinch
