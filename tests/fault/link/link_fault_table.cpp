#include "tests/fault/link/link_fault_table.h"

#include <array>

#include "tests/fault/link/trials.h"

namespace flinch::test {

std::span<const LinkFault> link_fault_table() {
  static constexpr std::array table = {
      LinkFault{"commander_killed", "the commander is killed", "robot: brakes", 10, &kill_commander},
      LinkFault{"commander_hung", "the commander hangs", "robot: brakes; when it goes on, it moves nothing",
                10, &hang_commander},
      LinkFault{"robot_killed", "the robot's program is killed", "commander: no torque, brakes", 10,
                &kill_robot},
      LinkFault{"robot_hung", "the robot's program hangs",
                "commander: no torque, brakes; robot: when it goes on, brakes", 10, &hang_robot},
      LinkFault{"link_cut", "the link is cut", "robot: brakes; commander: no torque, brakes", 10, &cut_link},
      LinkFault{"samples_lost", "of the datagrams 30 % are lost",
                "short gaps are bridged; after a longer one as when the link is cut", 10, &lose_samples},
      LinkFault{"samples_delayed", "all datagrams are held up for 20 ms",
                "as when the link is cut; the late commands are refused", 10, &delay_samples},
      LinkFault{"samples_duplicated_and_reordered", "datagrams come twice, or after later ones",
                "none; no sample counts twice or after a newer one", 0, &duplicate_and_reorder_samples},
      LinkFault{"clock_stepped", "the wall clock is stepped by an hour", "none", 0, &step_clock},
      LinkFault{"second_robot", "a second robot is on the bus",
                "no robot obeys a command that names another; a commander that has not begun sends none", 0,
                &second_robot},
      LinkFault{"second_commander", "a second program commands", "its commands are refused", 0,
                &second_commander},
      LinkFault{"commands_replayed", "commands of an earlier session are sent again", "they are refused", 0,
                &replay_commands},
      LinkFault{"other_version", "one end speaks another version of the protocol",
                "its samples are refused, and the user is told", 0, &wrong_version},
      LinkFault{"other_robot_file", "the ends have different robot files",
                "their samples are refused, and the user is told", 0, &other_robot_file},
      LinkFault{"joints_broken", "an angle of the drives is no number", "commander: no torque, brakes", 5,
                &broken_joints},
      LinkFault{"currents_broken", "a motor current is no number", "commander: controlled stop", 5,
                &broken_currents},
      LinkFault{"imu_gone", "the IMU has no readings", "none; control does not need it", 0, &missing_imu},
  };
  return table;
}

}  // namespace flinch::test
