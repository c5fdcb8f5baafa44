// The driver program of a robot with servo amplifiers of your own: what stands on the computer beside the
// robot, and what 'flinch link' and 'flinch run --station dds' talk to. It is the mirror image of 'flinch
// serve'.
//
//   fieldbus --readings, statuswords--> guards ----------------------------------> bus
//   fieldbus <--controlword, torque, brakes-- DriveManager, PowerStage <--commands-- bus
//
// Replace the class in my_amplifiers.cpp; everything else can stay. As it is, three drives are pretended.
//
//   example_04_drive_your_robot [SECONDS [DOMAIN [ROBOT.yaml [NAME]]]]
#include <atomic>
#include <charconv>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <string>

#include "apps/examples/04_drive_your_robot/amplifier_exchange.h"
#include "drivers/dds_server.h"
#include "drivers/wire_header.h"
#include "systems/config/config_file.h"
#include "systems/config/robot_file.h"
#include "systems/foundation/setup_error.h"
#include "systems/framework/exchange_list.h"
#include "systems/framework/realtime_runner.h"
#include "systems/framework/realtime_thread.h"

using namespace flinch;

namespace {

std::atomic<RealtimeRunner*> running = nullptr;

void end_in_order(int) {
  if (RealtimeRunner* const runner = running) runner->request_stop();
}

struct Arguments {
  double seconds = 1.0;        // a driver of yours runs until Ctrl-C
  std::uint32_t domain = 101;  // who shares the number shares the bus; 0 where nothing else is given
  std::string robot = "apps/robots/planar_3rrr.yaml";
  std::string name;  // of this robot, where several share the bus
};

/// The whole text as a number.
template <class Number>
bool reads(const std::string& text, Number& number) {
  const char* const end = text.data() + text.size();
  const auto [stopped, error] = std::from_chars(text.data(), end, number);
  return error == std::errc() && stopped == end;
}

Arguments arguments(int argc, char** argv) {
  Arguments given;
  if (argc > 1 && (!reads(argv[1], given.seconds) || !std::isfinite(given.seconds) || given.seconds <= 0.0))
    throw SetupError("SECONDS: is '" + std::string(argv[1]) + "'; it must be a number above 0");
  if (argc > 2 && !reads(argv[2], given.domain))
    throw SetupError("DOMAIN: is '" + std::string(argv[2]) + "'; it must be a whole number from 0 on");
  if (argc > 3) given.robot = argv[3];
  if (argc > 4) given.name = argv[4];
  return given;
}

bool drive(const Arguments& given) {
  const RobotFile robot = read_robot_file(given.robot);
  DiagramBuilder builder("driver", 1ms);
  const ExternalStation fieldbus = add_external_station(builder, robot.robot);
  const AmplifierStation station = add_amplifier_station(builder, fieldbus);
  const auto diagram = builder.build();
  Context context = diagram->make_context();

  MyAmplifiers amplifiers(robot.robot);
  AmplifierExchange exchange(amplifiers, *diagram, fieldbus, station);

  const int priority = permits_realtime(80) ? 80 : 0;
  const DdsBus bus({.domain = given.domain, .interface = "lo", .realtime_priority = priority});
  DdsServer server(bus, *diagram, station,
                   {.robot = robot_hash(read_config_file(given.robot)),  // or nobody is understood
                    .longest_silence = 6ms,                              // then no torque, and brakes
                    .longest_way = 5ms,                                  // later commands are refused
                    .robot_name = given.name,                            // for --robot, among several
                    .realtime_priority = priority});

  ExchangeList all({exchange, server});  // first the amplifiers, then who commands them
  ClockTicks ticks;                      // with EtherCAT: a TickSource of yours, by its distributed clock
  RealtimeRunner runner(*diagram, ticks, all);
  runner.follow_clock();
  const RealtimeThread thread({.priority = 80});  // beside a real robot: .scheduling = Requirement::require
  std::printf("%s", thread.report().text().c_str());
  running = &runner;
  std::signal(SIGINT, end_in_order);
  std::signal(SIGTERM, end_in_order);
  runner.run(context, from_seconds(given.seconds));
  running = nullptr;
  amplifiers.write({});  // at once: no torque, brakes, no voltage

  const TickStatistics& loop = runner.statistics();
  const DdsCommander commander = server.commander();
  std::printf("%lld ticks, %lld late starts, %lld lost periods; %u commands, %u refused, %u silences; %s\n",
              static_cast<long long>(loop.ticks), static_cast<long long>(loop.late_starts),
              static_cast<long long>(loop.lost_periods), commander.received, commander.refused,
              commander.silences, exchange.has_driven() ? "has driven" : "has stood still, brakes closed");
  return loop.ticks > 0 && (commander.received > 0 || !exchange.has_driven());
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return drive(arguments(argc, argv)) ? 0 : 1;
  } catch (const std::exception& error) {  // a SetupError says all that is wrong
    std::fprintf(stderr, "error: %s\n", error.what());
    return 2;
  }
}
