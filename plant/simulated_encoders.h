#pragma once

#include <cstdint>
#include <numbers>
#include <vector>

#include "plant/plant_truth.h"
#include "plant/position_wave.h"
#include "plant/sensor_noise.h"
#include "systems/framework/system.h"
#include "systems/robot/kinematics.h"
#include "systems/signals/joint_reading.h"

namespace flinch {

/// How far the encoders of one kind are off the truth [rad, or m where the joint slides].
struct EncoderErrors {
  double accuracy = 0.0;    ///< Standard deviation of a constant error, drawn once for each encoder.
  double noise = 0.0;       ///< Standard deviation of white noise.
  double resolution = 0.0;  ///< Readings are multiples of it.
  JointVector offset{};     ///< A constant error of each encoder, besides `accuracy`; empty: none.
  /// An error of each encoder that depends on the position, as of a disc that is not centred; empty: none.
  std::vector<PositionHarmonic> wave{};
};

/// The encoders of drives that slide, scales with numbers of their own: noise and resolution are assumed [m].
inline EncoderErrors sliding_encoders() { return {.noise = 7e-6, .resolution = 0.2e-6}; }

/// The encoders of the rig.
struct SimulatedEncodersSettings {
  bool ideal = false;           ///< Readings are the truth.
  bool passive_mounted = true;  ///< Otherwise passive angles are not valid.

  /// ECN1313; noise and resolution of [RAL25] IV-A. Its system accuracy of 0.0056 degrees is left out there.
  /// Where drives slide: `sliding_encoders`.
  EncoderErrors active{.accuracy = 0.0, .noise = 4e-4 * degree, .resolution = 1.2e-5 * degree};
  /// RI36-H: an accuracy of 0.1 degrees, [ICRA23] III-A, taken as the standard deviation of each encoder's
  /// error; 3600 lines, counted fourfold (assumed, not published).
  EncoderErrors passive{.accuracy = 0.1 * degree, .noise = 0.0, .resolution = 360.0 / 14400 * degree};

 private:
  static constexpr double degree = std::numbers::pi / 180.0;
};

/// Measures the joint angles at every tick; those of the drives on their motors.
class SimulatedEncoders final : public System {
  using Noise = NormalNumbers<2 * max_dof>;  // of the active, then of the passive joints

 public:
  /// `counts`: how many are measured; coupling joints are not. Throws SetupError where offsets or waves are
  /// not as many.
  SimulatedEncoders(const SimulatedEncodersSettings& settings, const JointCounts& counts, std::uint64_t seed);

 private:
  SimulatedEncodersSettings settings_;
  JointVector active_error_;
  JointVector passive_error_;
  State<Noise> noise_;

 public:
  InputPort<PlantTruth> truth = input<PlantTruth>("truth");
  OutputPort<JointReading> joints = output<&SimulatedEncoders::measure>("joints", truth, noise_);

 private:
  Update draw_ = update<&SimulatedEncoders::draw>(noise_);

  void measure(const PlantTruth& now, const Noise& noise, JointReading& reading) const;
  void draw(Noise& noise) const { noise.draw(); }
};

}  // namespace flinch
