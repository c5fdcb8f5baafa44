// A block of your own, alone in a diagram: a low-pass filter and the step that it answers.
//
// A block declares its ports and states as members. Each output and update is a const function which takes
// exactly what its declaration names, so the block can be tested by calling it, and nothing can be read by
// accident.
#include <cmath>
#include <cstdio>

#include "systems/framework/diagram_builder.h"
#include "systems/framework/simulator.h"

using flinch::operator""ms;

class LowPass final : public flinch::System {
  // States come first: what reads them is declared below.
  flinch::State<double> filtered_ = state<double>("filtered", 0.0);

 public:
  LowPass(double cut_off_hz, flinch::Time period)
      : share_(1.0 - std::exp(-2.0 * M_PI * cut_off_hz * flinch::to_seconds(period))) {}

  flinch::InputPort<double> raw = input<double>("raw");
  flinch::OutputPort<double> smooth = output<&LowPass::read>("smooth", filtered_);

 private:
  flinch::Update filter_ = update<&LowPass::filter>(filtered_, filtered_, raw);  // writes the first

  double read(double filtered) const { return filtered; }
  double filter(double filtered, double newest) const { return filtered + share_ * (newest - filtered); }

  double share_;
};

int main() {
  flinch::DiagramBuilder builder("example", 1ms);
  auto& low_pass = builder.add<LowPass>("low_pass", 10.0, 1ms);
  const auto step = builder.export_input("step", low_pass.raw);
  const auto diagram = builder.build();

  flinch::Context context = diagram->make_context();  // all that changes lives here
  context.set(step, 1.0);
  flinch::Simulator(*diagram).advance_to(context, 50ms);

  const double expected = 1.0 - std::exp(-2.0 * M_PI * 10.0 * 0.050);
  const double found = context.get(low_pass.smooth);
  std::printf("after 50 ms the filter shows %.6f; a first-order low pass would show %.6f\n", found, expected);
  return std::abs(found - expected) < 1e-12 ? 0 : 1;
}
