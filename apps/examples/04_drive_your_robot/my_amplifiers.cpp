#include "apps/examples/04_drive_your_robot/my_amplifiers.h"

#include <algorithm>

using namespace flinch;

namespace {

constexpr double torque_per_ampere = 6.5;       // of your motors and gears [Nm/A]
constexpr double most_torque = 50.0;            // that motor and gear stand [Nm]
constexpr double period = 1e-3;                 // of the fieldbus [s]
constexpr double inertia = 0.2, damping = 0.5;  // of a pretended drive [kg m^2], [Nms]

}  // namespace

MyAmplifiers::MyAmplifiers(std::shared_ptr<const ParallelRobot> robot) : robot_(std::move(robot)) {
  const InverseSolution home = robot_->inverse_kinematics(robot_->home_pose(), robot_->home_working_mode());
  for (std::size_t i = 0; i < 3; ++i) drives_[i].angle = home.joints.active[static_cast<int>(i)];
}

MyAmplifiers::~MyAmplifiers() { write({}); }

// With a fieldbus: receive the process data, and look whether all answered (EtherCAT: the working counter).
// Turn counts into radians with the sign and the zero of the robot file: the drive angle counts from the
// leg's base direction, anticlockwise seen from above. flinch link and a robot moved by hand show whether
// that is right.
AmplifierReadings MyAmplifiers::read() noexcept {
  AmplifierReadings readings;
  readings.answered = true;
  readings.active = readings.current = JointVector::Zero(3);
  for (std::size_t i = 0; i < 3; ++i) {
    const double wanted = orders_.torque.size() == 3 ? orders_.torque[static_cast<int>(i)] : 0.0;
    pretend(drives_[i], wanted);
    readings.active[static_cast<int>(i)] = drives_[i].angle;
    readings.current[static_cast<int>(i)] = drives_[i].torque / torque_per_ampere;
    readings.statuswords[i] = statusword_of(drives_[i].machine.state);
  }
  readings.passive = elbows(readings.active);
  readings.braked = orders_.close_brakes;
  return readings;
}

// With a fieldbus: torque to the amplifiers' unit (object 6071h: thousandths of the rated torque), cut to
// what the drives stand; controlword; brake output; send the process data.
void MyAmplifiers::write(const AmplifierOrders& orders) noexcept { orders_ = orders; }

void MyAmplifiers::pretend(PretendedDrive& drive, double wanted) const noexcept {
  const DriveCondition well{.started = true, .fault = false, .standstill = std::abs(drive.velocity) < 0.1};
  drive.machine = DriveStateMachine::next(drive.machine, {orders_.controlword}, well);
  const bool acts = drive.machine.state == DriveState::operation_enabled && !orders_.close_brakes;
  drive.torque = acts ? std::clamp(wanted, -most_torque, most_torque) : 0.0;
  drive.velocity += period * (drive.torque - damping * drive.velocity) / inertia;
  if (orders_.close_brakes) drive.velocity = 0.0;
  drive.angle += period * drive.velocity;
}

JointVector MyAmplifiers::elbows(const JointVector& active) noexcept {
  const WorkingMode mode = robot_->home_working_mode();
  const ForwardSolution platform = robot_->forward_kinematics(active, robot_->home_pose(), mode);
  if (!platform.converged) return {};
  return robot_->inverse_kinematics(platform.pose, mode).joints.passive;
}
