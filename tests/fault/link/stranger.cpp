#include "tests/fault/link/stranger.h"

#include "drivers/dds_writer.h"
#include "drivers/sample_sender.h"
#include "drivers/topics.h"
#include "experiments/scenario/robot_input.h"
#include "systems/framework/monotonic_clock.h"
#include "tests/fault/link/link_trial.h"

namespace flinch::test {
namespace {

/// Calls `send` every millisecond with 1, 2, 3 ...
[[noreturn]] void every_millisecond(const std::function<void(std::uint32_t)>& send) {
  for (std::uint32_t number = 1;; ++number) {
    send(number);
    MonotonicClock::sleep_until(MonotonicClock::now() + 1ms);
  }
}

void put_on(flinch_Header& header, std::uint32_t robot, std::uint16_t version, std::uint32_t number,
            std::uint64_t robot_id) {
  stamp(header, {.session = strangers_session, .robot = robot, .robot_id = robot_id}, number);
  header.acquired_ns = header.sent_ns;
  header.version = version;
  header.count = 3;
}

}  // namespace

std::uint32_t shipped_robot(const std::string& name) {
  return robot_hash(read_robot_input(shipped_file(name)).text);
}

OtherProgram stranger(std::uint32_t domain, std::uint32_t robot, std::uint16_t version,
                      std::uint64_t robot_id) {
  return OtherProgram([=] {
    const DdsBus bus({.domain = domain});
    DdsWriter requests(bus, drive_request_topic);
    DdsWriter commands(bus, torque_command_topic);
    flinch_DriveRequest request{};
    put_on(request.header, robot, version, 1, robot_id);
    request.header.flags = flag_valid;
    request.wanted = 2;
    requests.write(&request);
    every_millisecond([&](std::uint32_t number) {
      flinch_TorqueSample command{};
      put_on(command.header, robot, version, number, robot_id);
      command.header.flags = number <= 50 ? flag_engage_brake : flag_valid;
      for (int i = 0; i < 3; ++i) command.torque[i] = number <= 50 ? 0.0 : strangers_torque;
      commands.write(&command);
    });
  });
}

OtherProgram replayer(std::uint32_t domain, const std::vector<flinch_DriveRequest>& requests,
                      const std::vector<flinch_TorqueSample>& commands) {
  return OtherProgram([&, domain] {
    const DdsBus bus({.domain = domain});
    DdsWriter request_writer(bus, drive_request_topic);
    DdsWriter command_writer(bus, torque_command_topic);
    for (const flinch_DriveRequest& request : requests) request_writer.write(&request);
    MonotonicClock::sleep_until(MonotonicClock::now() + 300ms);  // until the robot listens
    every_millisecond(
        [&](std::uint32_t number) { command_writer.write(&commands[(number - 1) % commands.size()]); });
  });
}

OtherProgram strange_robot(std::uint32_t domain, std::uint32_t robot, std::uint16_t version) {
  return OtherProgram([=] {
    const DdsBus bus({.domain = domain});
    DdsWriter writer(bus, joints_topic);
    every_millisecond([&](std::uint32_t number) {
      flinch_JointSample sample{};
      put_on(sample.header, robot, version, number, strangers_robot);
      sample.header.flags = flag_valid | flag_passive_valid;
      writer.write(&sample);
    });
  });
}

}  // namespace flinch::test
