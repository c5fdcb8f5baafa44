#include "plant/contacts_at_start.h"

#include <sstream>

#include "plant/bench_dynamics.h"

namespace flinch {

std::vector<std::string> contacts_at_start(const BenchSettings& settings) {
  const std::unique_ptr<const BenchDynamics> bench = BenchDynamics::make(settings);
  const Mechanism& robot = bench->robot();
  BenchSnapshot start;
  DriveAction resting;
  resting.torque.setZero(robot.drives());
  bench->snapshot(bench->initial_state(), resting, PlatformVector::Zero(robot.dof()), bench->initial_step(),
                  0.0, start);
  std::vector<std::string> found;
  for (int i = 0; i < start.contacts.touch_count; ++i) {
    const Touch& touch = start.contacts.touches[static_cast<std::size_t>(i)];
    std::ostringstream sentence;
    sentence.precision(3);
    sentence << "begins in contact: " << robot.body(BodyId::from_index(touch.body)).name << " is "
             << 1e3 * touch.depth << " mm deep in "
             << settings.obstacles[static_cast<std::size_t>(touch.obstacle)]->form().name
             << "; move the obstacle or the start";
    found.push_back(sentence.str());
  }
  return found;
}

}  // namespace flinch
