#include "drivers/robot_pace.h"

#include <drivers/idl/flinch.h>

#include "drivers/sample_receiver.h"

namespace flinch {

std::optional<Pace> find_pace(const DdsBus& bus, std::uint32_t robot, const std::string& chosen_robot,
                              Time patience, const std::function<bool()>& gives_up) {
  RobotSelection robots(chosen_robot);
  const AdmissionSettings any_pace{.robot = robot, .robots = &robots, .pace = std::nullopt};
  SampleReceiver<flinch_StatusSample> status(bus, status_topic, any_pace);
  const SampleReceiver<flinch_JointSample> joints(bus, joints_topic, any_pace);  // of robots without status
  const Time deadline = MonotonicClock::now() + patience;
  ReceivedSample<flinch_StatusSample> last;
  for (Time now = MonotonicClock::now(); now < deadline && !gives_up(); now = MonotonicClock::now()) {
    const bool is_misunderstood = status.refused() + joints.refused() > 0 && robots.count() == 0;
    if (robots.is_undecided(now) || is_misunderstood) return std::nullopt;
    status.take(last);
    if (robots.take(now) != 0 && last.sample.header.robot_id == robots.taken())
      return pace_of(last.sample.header);
    MonotonicClock::sleep_until(now + 10ms);
  }
  return std::nullopt;
}

}  // namespace flinch
