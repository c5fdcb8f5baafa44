#include <flinch/framework.h>
#include <flinch/robot.h>

#include <cmath>
#include <cstdio>
#include <memory>

namespace {

/// A user's own block: the drive angles that hold the platform at a pose.
class HoldPose final : public flinch::System {
 public:
  explicit HoldPose(std::shared_ptr<const flinch::ParallelRobot> robot) : robot_(std::move(robot)) {}

  flinch::InputPort<flinch::PlatformVector> pose = input<flinch::PlatformVector>("pose");
  flinch::OutputPort<flinch::JointVector> drives = output<&HoldPose::solve>("drives", pose);

 private:
  flinch::JointVector solve(const flinch::PlatformVector& wanted) const {
    return robot_->inverse_kinematics(wanted, robot_->home_working_mode()).joints.active;
  }

  std::shared_ptr<const flinch::ParallelRobot> robot_;
};

}  // namespace

/// Holds the rig at home and checks that forward kinematics finds the way back.
int main() {
  using namespace flinch;
  const auto robot =
      std::make_shared<const PlanarRrr>(rig_robot(RigGeometry::individual, RigFriction::test_rig));

  DiagramBuilder builder;
  auto& home = builder.add<Constant<PlatformVector>>("home", robot->home_pose());
  auto& hold = builder.add<HoldPose>("hold", robot);
  builder.connect(home.value, hold.pose);
  const auto diagram = builder.build();

  auto context = diagram->make_context();
  Simulator(*diagram).advance_to(context, 10ms);
  const auto found =
      robot->forward_kinematics(context.get(hold.drives), robot->home_pose(), robot->home_working_mode());
  const double miss = robot->difference(found.pose, robot->home_pose()).norm();
  std::printf("forward kinematics misses the home pose by %.1e\n", miss);
  return found.converged && miss < 1e-9 ? 0 : 1;
}
