#pragma once

#include <array>
#include <cstdint>
#include <memory>

#include "drivers/drive_state_machine.h"
#include "systems/robot/parallel_robot.h"

/// What the amplifiers tell once a millisecond, in units and signs of the robot file.
struct AmplifierReadings {
  bool answered = false;        ///< all of them, in this cycle; false: nothing else here counts
  flinch::JointVector active;   ///< encoders of the drives [rad]
  flinch::JointVector passive;  ///< encoders of the elbows [rad]; empty: not mounted
  flinch::JointVector current;  ///< torque-producing [A]
  std::array<std::uint16_t, 3> statuswords{};
  bool braked = false;  ///< the brakes are closed
  bool fault = false;   ///< what a statusword does not tell: an open safety circuit, a supply that is down
};

/// What they shall do until they are told otherwise.
struct AmplifierOrders {
  std::uint16_t controlword = 0;  ///< the same for all
  flinch::JointVector torque;     ///< [Nm]; empty: none
  bool close_brakes = true;
};

/// Three servo amplifiers on a fieldbus. THIS CLASS IS YOURS: put your fieldbus master here. What stands in
/// this file now only pretends: three drives with inertia and damping each, for themselves, with no robot
/// between.
class MyAmplifiers {
 public:
  /// Here: open the fieldbus, bring it to its operational state, and switch on the watchdog of every
  /// amplifier, so that it brakes by itself within a few milliseconds when this program dies. Throw
  /// flinch::SetupError with what is wrong.
  explicit MyAmplifiers(std::shared_ptr<const flinch::ParallelRobot> robot);
  /// Leaves the amplifiers without voltage and the brakes closed, however the program ends.
  ~MyAmplifiers();
  MyAmplifiers(const MyAmplifiers&) = delete;
  MyAmplifiers& operator=(const MyAmplifiers&) = delete;

  /// What the last cycle of the fieldbus has brought. In the loop: it may not wait, allocate, lock or throw.
  AmplifierReadings read() noexcept;
  /// What the next cycle shall carry. In the loop, as read().
  void write(const AmplifierOrders& orders) noexcept;

 private:
  struct PretendedDrive {
    flinch::DriveStateMachine::Memory machine;
    double angle = 0.0, velocity = 0.0, torque = 0.0;
  };
  void pretend(PretendedDrive& drive, double wanted) const noexcept;
  flinch::JointVector elbows(const flinch::JointVector& active) noexcept;

  std::shared_ptr<const flinch::ParallelRobot> robot_;
  std::array<PretendedDrive, 3> drives_;
  AmplifierOrders orders_;
};
