#include "systems/framework/simulator.h"

#include "systems/foundation/setup_error.h"
#include "systems/framework/block_profile.h"
#include "systems/framework/diagram.h"
#include "systems/framework/recorder.h"
#include "systems/framework/runge_kutta.h"

namespace flinch {

/// The diagram's continuous part during one tick.
class Simulator::Step final : public DifferentialEquation {
 public:
  Step(const Diagram& diagram, Context& context, BlockProfile* profile)
      : diagram_(diagram), context_(context), profile_(profile), start_(context.time()) {
    diagram_.begin_step(context_, profile_);
  }

  void rates(double t, std::span<const double> y, std::span<double> rates) override {
    context_.set_time(start_ + from_seconds(t));
    diagram_.set_continuous(context_, y);
    diagram_.derivatives(context_, rates, profile_);
  }

 private:
  const Diagram& diagram_;
  Context& context_;
  BlockProfile* profile_;
  Time start_;
};

namespace {

std::unique_ptr<Integrator> default_integrator(const Diagram& diagram) {
  if (const std::string block = diagram.needing_adaptive_steps(); !block.empty()) {
    throw SetupError("the motion of '" + block + "' in the diagram '" + diagram.name() +
                     "' needs an integrator that adapts its steps; give the Simulator one, such as "
                     "std::make_unique<SundialsIntegrator>()");
  }
  return std::make_unique<RungeKutta>();
}

}  // namespace

Simulator::Simulator(const Diagram& diagram, std::unique_ptr<Integrator> integrator)
    : diagram_(diagram),
      integrator_(integrator ? std::move(integrator) : default_integrator(diagram)),
      continuous_(diagram.continuous_size()) {
  integrator_->prepare(continuous_.size());
}

Simulator::~Simulator() = default;

void Simulator::evaluate(Context& context) const { diagram_.evaluate(context, profile_); }

void Simulator::advance(Context& context) {
  const Time next = context.time() + diagram_.tick();
  for (Recorder* recorder : recorders_) recorder->record(context);
  diagram_.update(context, profile_);
  if (!continuous_.empty()) integrate(context);
  context.set_time(next);
  if (profile_ != nullptr) profile_->end_tick();
}

void Simulator::integrate(Context& context) {
  Step equation(diagram_, context, profile_);
  diagram_.get_continuous(context, continuous_);
  if (!integrator_->advance(equation, to_seconds(diagram_.tick()), continuous_)) ++inaccurate_steps_;
  diagram_.set_continuous(context, continuous_);
}

void Simulator::step(Context& context) {
  evaluate(context);
  advance(context);
}

void Simulator::advance_to(Context& context, Time end) {
  while (context.time() < end) step(context);
  diagram_.evaluate(context);
}

}  // namespace flinch
