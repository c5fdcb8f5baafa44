#include "plant/contacts_at_start.h"

#include <sstream>

#include "plant/rig_dynamics.h"

namespace flinch {

std::vector<ContactAtStart> contacts_at_start(const RigSettings& settings) {
  const std::unique_ptr<const RigDynamics> rig = RigDynamics::make(settings);
  const Mechanism& robot = rig->robot();
  RigSnapshot start;
  DriveAction resting;
  resting.torque.setZero(robot.drives());
  rig->snapshot(rig->initial_state(), resting, PlatformVector::Zero(robot.dof()), rig->initial_step(), 0.0,
                start);
  std::vector<ContactAtStart> found;
  for (int i = 0; i < start.contacts.touch_count; ++i) {
    const Touch& touch = start.contacts.touches[static_cast<std::size_t>(i)];
    const auto obstacle = static_cast<std::size_t>(touch.obstacle);
    std::ostringstream sentence;
    sentence.precision(3);
    sentence << "begins in contact: " << robot.body(BodyId::from_index(touch.body)).name << " is "
             << 1e3 * touch.depth << " mm deep in " << settings.obstacles[obstacle]->form().name
             << "; move the obstacle or the start";
    found.push_back({obstacle, sentence.str()});
  }
  return found;
}

}  // namespace flinch
