#pragma once

#include <algorithm>
#include <functional>
#include <memory>
#include <utility>
#include <vector>

#include "systems/framework/diagram_builder.h"
#include "systems/framework/exchange.h"
#include "systems/framework/tick_source.h"
#include "systems/framework/tick_timing.h"
#include "tests/support/blocks.h"

/// A diagram to run in real time, and a world whose clock moves only as a test says.
namespace flinch::test {

/// Ticks by a clock that stands still unless somebody waits, or work() is called.
class FakeClockTicks final : public TickSource {
 public:
  Time now() override { return now_; }
  void wait(Time due) override { now_ = std::max(now_, due) + wake_delay; }
  void work(Time duration) { now_ += duration; }

  Time wake_delay{};

 private:
  Time now_ = 5s;
};

/// Calls functions, where given.
class Calls final : public Exchange {
 public:
  std::function<void(Context&)> before;
  std::function<void(const Context&)> after;

  void set_inputs(Context& context) override {
    if (before) before(context);
  }
  void take_outputs(const Context& context) override {
    if (after) after(context);
  }
};

/// Shows the timing of its ticks.
class TimingView final : public System {
 public:
  InputPort<TickTiming> timing = input<TickTiming>("timing");
  OutputPort<TickTiming> seen = output<&TimingView::show>("seen", timing);

 private:
  TickTiming show(const TickTiming& timing_now) const { return timing_now; }
};

/// An input that pushes a decay, a delayed sum, a counter, and the timing of ticks.
struct Station {
  std::unique_ptr<Diagram> diagram;
  InputPort<double> push;
  InputPort<TickTiming> timing;
  OutputPort<double> count;
  OutputPort<double> sum;

  static Station build() {
    DiagramBuilder builder("station", 1ms);
    auto& decay = builder.add<Decay>("decay", -30.0, 1.0);
    auto& counter = builder.add<Counter>("counter");
    auto& adder = builder.add<Adder>("adder");
    auto& delay = builder.add<Delay>("delay", Every{4ms, 1ms});
    auto& view = builder.add<TimingView>("view");
    const auto push = builder.export_input("push", decay.push);
    const auto timing = builder.export_input("timing", view.timing);
    builder.connect(decay.x, delay.in);
    builder.connect(delay.out, adder.a);
    builder.connect(counter.count, adder.b);
    const auto count = builder.export_output("count", counter.count);
    const auto sum = builder.export_output("sum", adder.sum);
    return {builder.build(), push, timing, count, sum};
  }
};

}  // namespace flinch::test
