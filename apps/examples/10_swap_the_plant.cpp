// One control path before two robots, the simulated one and one on the bus: only the station is another.
//   example_10_swap_the_plant          simulated in this program
//   example_10_swap_the_plant DOMAIN   on the bus: flinch serve platform_collision --lockstep --domain DOMAIN
// In lockstep both say the same; a real robot needs ClockTicks and follow_clock(). Start it in the root.
#include <flinch/drivers.h>
#include <flinch/framework.h>
#include <flinch/live_experiments.h>
#include <flinch/plant.h>
#include <flinch/simulated_experiments.h>
#include <cstdio>

using namespace flinch;

static void run_on_bus(const Diagram& diagram, const ExternalStation& station, const Scenario& scenario,
                       std::uint32_t domain, Context& context) {
  const DdsBus bus({.domain = domain});
  DdsStation link(bus, diagram, station, {.robot = robot_hash(scenario.robot_text), .pace = Pace::lockstep});
  if (!await_robot(link, 10s, no_interrupts)) throw_if_undecided(link);
  LockstepTicks ticks(link, 10s, [] { return false; });
  if (!ticks.begin()) throw SetupError("the robot obeys another program");
  RealtimeRunner(diagram, ticks, link).run(context, scenario.duration);
  ticks.let_go();
}

static std::uint32_t domain_of(const std::string& text) {
  if (!text.empty() && text.size() < 4 && text.find_first_not_of("0123456789") == text.npos)
    return static_cast<std::uint32_t>(std::stoul(text));
  throw SetupError("DOMAIN: is '" + text + "'; it must be a whole number from 0 on");
}

int main(int argc, char** argv) try {
  const auto scenario = read_simulated_scenario("apps/scenarios/platform_collision.yaml");
  DiagramBuilder builder("one_of_two_robots");
  const auto control = add_contact_control(builder, scenario.robot.robot, scenario.control);
  builder.fix(OperatorCommand{}, control.operator_command);
  builder.fix(TickTiming{}, control.tick_timing);
  std::optional<ExternalStation> outside;
  if (argc > 1) {
    outside = add_external_station(builder, scenario.robot.robot, {.lockstep = true});
    connect(builder, *outside, control);
  } else {
    connect(builder, add_simulated_station(builder, scenario.station), control);
  }
  const auto diagram = builder.build();
  Context context = diagram->make_context();
  if (outside) {
    run_on_bus(*diagram, *outside, scenario, domain_of(argv[1]), context);
  } else {
    Simulator simulator(*diagram, std::make_unique<SundialsIntegrator>());
    while (context.time() < scenario.duration) simulator.step(context);
  }
  const ContactDetection& contact = context.get(control.detection);
  const Eigen::Vector2d rests = 1e3 * context.get(control.platform_motion).pose.head<2>();
  std::printf("contact detected at %.3f s, the platform rests at %.3f, %.3f mm\n",
              to_seconds(contact.detected), rests.x(), rests.y());
  return contact.level != ContactLevel::none && context.get(control.faults).none() ? 0 : 1;
} catch (const std::exception& error) {  // a SetupError says all that is wrong
  std::fprintf(stderr, "error: %s\n", error.what());
  return 2;
}
