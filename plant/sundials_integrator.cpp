#include "plant/sundials_integrator.h"

#include <arkode/arkode_butcher_erk.h>
#include <arkode/arkode_erkstep.h>
#include <nvector/nvector_serial.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <sundials/sundials_context.hpp>
#include <type_traits>
#include <vector>

#include "plant/single_step.h"
#include "systems/foundation/findings.h"
#include "systems/foundation/setup_error.h"
#include "systems/framework/runge_kutta.h"

namespace flinch {
namespace {

constexpr int fallback_steps = 200;
constexpr int first_order_controller = 2;  // ARKODE's number of the controller that remembers no earlier step
constexpr int max_rejected_steps = 100;

// ---------------------------------------------------------------- vector operations
// For a handful of states, SUNDIALS' own cost as much as the mathematics.

double* data(N_Vector v) { return NV_CONTENT_S(v)->data; }
std::size_t size(N_Vector v) { return static_cast<std::size_t>(NV_CONTENT_S(v)->length); }
std::span<double> numbers(N_Vector v) { return {data(v), size(v)}; }

void linear_sum(double a, N_Vector x, double b, N_Vector y, N_Vector sum) {
  for (std::size_t i = 0; i < size(sum); ++i) data(sum)[i] = a * data(x)[i] + b * data(y)[i];
}

void scale(double factor, N_Vector x, N_Vector scaled) {
  for (std::size_t i = 0; i < size(scaled); ++i) data(scaled)[i] = factor * data(x)[i];
}

double weighted_rms(N_Vector x, N_Vector weight) {
  double sum = 0.0;
  for (std::size_t i = 0; i < size(x); ++i)
    sum += (data(x)[i] * data(weight)[i]) * (data(x)[i] * data(weight)[i]);
  return std::sqrt(sum / static_cast<double>(size(x)));
}

/// `together` numbers of a sum over k of factors[k] terms[k], from `first` on. Their count is a constant, so
/// that they stay in registers.
template <std::size_t together>
void combine(int count, const double* factors, N_Vector* terms, std::size_t first, N_Vector combination) {
  std::array<double, together> sum{};
  for (int k = 0; k < count; ++k) {
    const double factor = factors[k];
    const double* const term = data(terms[k]) + first;
    for (std::size_t i = 0; i < together; ++i) sum[i] += factor * term[i];
  }
  std::copy_n(sum.begin(), together, data(combination) + first);
}

// combination = sum over k of factors[k] terms[k]; one of the terms may be `combination` itself.
int linear_combination(int count, double* factors, N_Vector* terms, N_Vector combination) {
  constexpr std::size_t together = 6;  // divides the states of robots with 3 and with 6 coordinates
  std::size_t done = 0;
  for (; done + together <= size(combination); done += together)
    combine<together>(count, factors, terms, done, combination);
  for (; done < size(combination); ++done) combine<1>(count, factors, terms, done, combination);
  return 0;
}

void use_own_operations(N_Vector v) {
  v->ops->nvlinearsum = linear_sum;
  v->ops->nvscale = scale;
  v->ops->nvwrmsnorm = weighted_rms;
  v->ops->nvlinearcombination = linear_combination;
}

void ignore_message(int, const char*, const char*, char*, void*) {}

ARKODE_ERKTableID table(SundialsOptions::Tableau tableau) {
  return tableau == SundialsOptions::Tableau::cash_karp ? ARKODE_CASH_KARP_6_4_5
                                                        : ARKODE_DORMAND_PRINCE_7_4_5;
}

/// y' = 0
class Rest final : public DifferentialEquation {
 public:
  void rates(double, std::span<const double>, std::span<double> rates) override {
    std::fill(rates.begin(), rates.end(), 0.0);
  }
};

ButcherTable coefficients(ARKODE_ERKTableID id) {
  struct Free {
    void operator()(ARKodeButcherTable table) const { ARKodeButcherTable_Free(table); }
  };
  const std::unique_ptr<ARKodeButcherTableMem, Free> theirs(ARKodeButcherTable_LoadERK(id));
  if (theirs == nullptr) throw SetupError("SUNDIALS does not know this Runge-Kutta method");
  const auto stages = static_cast<std::size_t>(theirs->stages);
  ButcherTable table;
  for (std::size_t i = 0; i < stages; ++i) {
    table.A.emplace_back(theirs->A[i], theirs->A[i] + i);
    table.b.push_back(theirs->b[i]);
    table.c.push_back(theirs->c[i]);
    table.error.push_back(theirs->b[i] - theirs->d[i]);
  }
  return table;
}

std::vector<std::string> problems(const SundialsOptions& options) {
  Findings found;
  found.positive("relative_tolerance", options.relative_tolerance);
  found.positive("absolute_tolerance", options.absolute_tolerance);
  found.positive("max_steps", options.max_steps);
  return found.take();
}

}  // namespace

/// One ARKODE solver with its vectors, for a fixed number of states.
class SundialsIntegrator::Solver {
 public:
  Solver(const SundialsOptions& options, std::size_t size);

  bool advance(DifferentialEquation& equation, double duration, std::span<double> y);
  std::int64_t evaluations() const { return evaluations_; }

 private:
  static int rates(double t, N_Vector y, N_Vector rates, void* solver);
  static int error_weights(N_Vector y, N_Vector weights, void* solver);
  static int end_step(double t, N_Vector y, void* solver);
  static void require(int flag);
  /// With steps that SUNDIALS chooses; false, and y as it was, where it finds none.
  bool adapt(DifferentialEquation& equation, double duration, std::span<double> y);
  void write_error_weights(std::span<const double> y, std::span<double> weights) const;

  struct Destroy {
    void operator()(N_Vector v) const { N_VDestroy(v); }
  };
  struct Free {
    void operator()(void* memory) const { ERKStepFree(&memory); }
  };

  SundialsOptions options_;
  sundials::Context context_;  // outlives what is made with it
  std::unique_ptr<std::remove_pointer_t<N_Vector>, Destroy> y_;
  std::unique_ptr<void, Free> memory_;
  SingleStep single_step_;
  std::vector<double> weights_;
  DifferentialEquation* equation_ = nullptr;
  double duration_ = 0.0;
  bool is_done_ = false;  ///< the end of the tick is reached
  std::int64_t evaluations_ = 0;
  RungeKutta fallback_{fallback_steps};
};

SundialsIntegrator::Solver::Solver(const SundialsOptions& options, std::size_t size)
    : options_(options),
      y_(N_VNew_Serial(static_cast<sunindextype>(size), context_)),
      single_step_(coefficients(table(options.tableau)), size),
      weights_(size) {
  use_own_operations(y_.get());
  N_VConst(0.0, y_.get());
  memory_.reset(ERKStepCreate(rates, 0.0, y_.get(), context_));
  if (memory_ == nullptr) throw SetupError("SUNDIALS could not create an integrator");
  void* const memory = memory_.get();
  require(ERKStepSetErrHandlerFn(memory, ignore_message, nullptr));
  require(ERKStepSetUserData(memory, this));
  require(ERKStepWFtolerances(memory, error_weights));
  require(ERKStepSetPostprocessStepFn(memory, end_step));
  require(ERKStepSetTableNum(memory, table(options.tableau)));
  require(ERKStepSetInterpolantDegree(memory, 1));
  require(ERKStepSetAdaptivityMethod(memory, first_order_controller, 1, 0, nullptr));
  require(ERKStepSetMaxErrTestFails(memory, max_rejected_steps));
  require(ERKStepSetMaxNumSteps(memory, options.max_steps));
  fallback_.prepare(size);
  Rest rest;
  adapt(rest, 1.0, weights_);  // its first step allocates
  evaluations_ = 0;
}

void SundialsIntegrator::Solver::require(int flag) {
  if (flag != ARK_SUCCESS) throw SetupError("SUNDIALS refused an option with code " + std::to_string(flag));
}

// SUNDIALS would take the same step first, for a multiple of the cost.
bool SundialsIntegrator::Solver::advance(DifferentialEquation& equation, double duration,
                                         std::span<double> y) {
  single_step_.take(equation, duration, y);
  evaluations_ += single_step_.stages();
  write_error_weights(y, weights_);
  if (single_step_.error(weights_) <= 1.0) {
    single_step_.write(y);
    return true;
  }
  if (adapt(equation, duration, y)) return true;
  fallback_.advance(equation, duration, y);
  return false;
}

bool SundialsIntegrator::Solver::adapt(DifferentialEquation& equation, double duration, std::span<double> y) {
  equation_ = &equation;
  duration_ = duration;
  is_done_ = false;
  std::copy(y.begin(), y.end(), data(y_.get()));
  double reached = 0.0;
  void* const memory = memory_.get();
  const bool ready = ERKStepReset(memory, 0.0, y_.get()) == ARK_SUCCESS &&
                     ERKStepSetInitStep(memory, duration) == ARK_SUCCESS &&
                     ERKStepSetStopTime(memory, duration) == ARK_SUCCESS;
  if (!ready || ERKStepEvolve(memory, duration, y_.get(), &reached, ARK_NORMAL) < 0) return false;
  std::copy_n(data(y_.get()), y.size(), y.begin());
  return true;
}

int SundialsIntegrator::Solver::rates(double t, N_Vector y, N_Vector rates, void* solver) {
  auto& self = *static_cast<Solver*>(solver);
  if (self.is_done_) return 0;  // asked for a step that never follows: every tick starts afresh
  if (const auto known = self.single_step_.known_rates(t, numbers(y)); !known.empty()) {
    std::copy(known.begin(), known.end(), data(rates));
    return 0;
  }
  ++self.evaluations_;
  self.equation_->rates(t, numbers(y), numbers(rates));
  return 0;
}

/// Called after each step that is accepted, before the rates at its end are asked for.
int SundialsIntegrator::Solver::end_step(double t, N_Vector, void* solver) {
  auto& self = *static_cast<Solver*>(solver);
  self.is_done_ = t >= self.duration_;
  return 0;
}

int SundialsIntegrator::Solver::error_weights(N_Vector y, N_Vector weights, void* solver) {
  static_cast<Solver*>(solver)->write_error_weights(numbers(y), numbers(weights));
  return 0;
}

void SundialsIntegrator::Solver::write_error_weights(std::span<const double> y,
                                                     std::span<double> weights) const {
  for (std::size_t i = 0; i < y.size(); ++i)
    weights[i] = 1.0 / (options_.relative_tolerance * std::abs(y[i]) + options_.absolute_tolerance);
}

// ---------------------------------------------------------------- SundialsIntegrator

SundialsIntegrator::SundialsIntegrator(const SundialsOptions& options) : options_(options) {
  throw_if_any(problems(options));
}

SundialsIntegrator::~SundialsIntegrator() = default;

void SundialsIntegrator::prepare(std::size_t size) {
  solver_ = size > 0 ? std::make_unique<Solver>(options_, size) : nullptr;
}

bool SundialsIntegrator::advance(DifferentialEquation& equation, double duration, std::span<double> y) {
  return solver_ == nullptr || solver_->advance(equation, duration, y);
}

std::int64_t SundialsIntegrator::evaluations() const { return solver_ ? solver_->evaluations() : 0; }

}  // namespace flinch
