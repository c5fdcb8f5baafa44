#include "systems/framework/realtime_runner.h"

#include <algorithm>
#include <utility>

#include "systems/foundation/setup_error.h"
#include "systems/framework/diagram.h"
#include "systems/framework/exchange.h"

namespace flinch {

RealtimeRunner::RealtimeRunner(const Diagram& diagram, TickSource& ticks, Exchange& exchange,
                               std::unique_ptr<Integrator> integrator)
    : diagram_(diagram), ticks_(ticks), exchange_(exchange), simulator_(diagram, std::move(integrator)) {}

void RealtimeRunner::feed_timing(InputPort<TickTiming> input) {
  if (input.id.owner != &diagram_) {
    throw SetupError("the timing of ticks was to be fed into an input that is not one of the diagram '" +
                     diagram_.name() + "' itself; export it, and feed what export_input() returns");
  }
  timing_slot_ = diagram_.slot(input);
}

void RealtimeRunner::follow_clock() {
  if (diagram_.continuous_size() > 0) {
    throw SetupError("the time of the diagram '" + diagram_.name() +
                     "' cannot follow the clock, for it has continuous states to integrate");
  }
  follows_clock_ = true;
}

TickTiming RealtimeRunner::time_start(Time due, const TickDurations& previous) {
  TickTiming timing;
  timing.valid = true;
  timing.started = ticks_.now();
  timing.lateness = std::max(Time::zero(), timing.started - due);
  timing.late = timing.lateness > std::min<Time>(late_start, diagram_.tick() / 2);
  timing.lost_periods = timing.lateness / diagram_.tick();
  timing.previous = previous;
  return timing;
}

TickDurations RealtimeRunner::tick(Context& context, const TickTiming& timing) {
  if (timing_slot_) context[*timing_slot_] = timing;
  exchange_.set_inputs(context);
  simulator_.evaluate(context);
  exchange_.take_outputs(context);
  const Time evaluated = ticks_.now();
  simulator_.advance(context);
  const Time ended = ticks_.now();

  const Time whole = ended - timing.started;
  return {.valid = true,
          .overran = whole > diagram_.tick(),
          .evaluation = evaluated - timing.started,
          .update = ended - evaluated,
          .whole = whole};
}

void RealtimeRunner::run(Context& context, Time end, const std::function<bool()>& done) {
  const Time period = diagram_.tick();
  TickDurations durations;
  Time due = ticks_.first_due(ticks_.now(), period);
  while (context.time() < end && !stop_requested()) {
    ticks_.wait(due);
    if (stop_requested() || ticks_.is_over()) return;
    const TickTiming timing = time_start(due, durations);
    statistics_.count_start(timing);
    if (follows_clock_) context.set_time(context.time() + timing.lost_periods * period);
    durations = tick(context, timing);
    statistics_.count_end(durations);
    if (done && done()) return;
    due += (timing.lost_periods + 1) * period;
  }
}

}  // namespace flinch
