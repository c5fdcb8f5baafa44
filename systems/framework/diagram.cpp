#include "systems/framework/diagram.h"

#include <algorithm>

#include "systems/foundation/nearest_name.h"
#include "systems/foundation/setup_error.h"
#include "systems/framework/block_profile.h"

namespace flinch {

Diagram::~Diagram() = default;

void Diagram::run(std::span<const Call> calls, std::byte* memory, BlockProfile* profile) const {
  if (profile != nullptr) return run_timed(calls, memory, *profile);
  const Place* places = places_.data();
  for (const Call& call : calls) call.function(*call.block, memory, places + call.first_place);
}

void Diagram::run_timed(std::span<const Call> calls, std::byte* memory, BlockProfile& profile) const {
  profile.start_calls();
  for (const Call& call : calls) {
    call.function(*call.block, memory, places_.data() + call.first_place);
    profile.end_call(*call.block);
  }
}

void Diagram::evaluate(Context& context, BlockProfile* profile) const {
  std::byte* memory = context.memory();
  for (const DoubleBuffer& turns : kept_outputs_) turns.begin(memory);
  const std::span<const Call> calls = outputs_in_order_;
  std::size_t next = 0;
  for (const HeldOutputs& held : held_outputs_) {
    run(calls.subspan(next, held.begin - next), memory, profile);
    next = held.end;
    bool& computed = internal::at<bool>(memory, held.computed);
    if (is_due(held, context)) {
      for (const DoubleBuffer& turns : held.turns) turns.begin(memory);
      run(calls.subspan(held.begin, held.end - held.begin), memory, profile);
      computed = true;
    } else if (computed) {  // by an evaluation of this tick before, which no longer counts
      for (const DoubleBuffer& turns : held.turns) turns.stay(memory);
      computed = false;
    }
  }
  run(calls.subspan(next), memory, profile);
}

bool Diagram::is_due(const HeldOutputs& held, const Context& context) const {
  if (context.at_first_tick()) return true;
  return held.every ? context.due(*held.every) : internal::at<bool>(context.memory(), held.when);
}

void Diagram::update(Context& context, BlockProfile* profile) const {
  std::byte* memory = context.memory();
  for (const UpdateGroup& group : update_groups_) {
    if (context.due(group.every)) run(group.calls, memory, profile);
  }
  for (const UpdateGroup& group : update_groups_) {
    if (!context.due(group.every)) continue;
    for (const Copy& copy : group.copies) copy.type->copy_assign(copy.to.in(memory), copy.from.in(memory));
    for (const DoubleBuffer& turns : group.kept) turns.end(memory);
  }
  for (const HeldOutputs& held : held_outputs_) {
    bool& computed = internal::at<bool>(memory, held.computed);
    if (!computed) continue;
    for (const DoubleBuffer& turns : held.turns) turns.end(memory);
    computed = false;
  }
  context.complete_tick();
}

void Diagram::get_continuous(const Context& context, std::span<double> numbers) const {
  auto to = numbers.begin();
  for (const StateCell& cell : continuous_cells_) {
    auto* memory = const_cast<std::byte*>(cell.now.in(context.memory()));  // numbers() only looks
    const std::span<const double> value = cell.type->numbers(memory);
    to = std::copy(value.begin(), value.end(), to);
  }
}

void Diagram::set_continuous(Context& context, std::span<const double> numbers) const {
  auto from = numbers.begin();
  for (const StateCell& cell : continuous_cells_) {
    const std::span<double> value = cell.type->numbers(cell.now.in(context.memory()));
    std::copy_n(from, value.size(), value.begin());
    from += static_cast<std::ptrdiff_t>(value.size());
  }
}

void Diagram::begin_step(Context& context, BlockProfile* profile) const {
  for (const DoubleBuffer& turns : kept_in_step_) turns.begin(context.memory());
  run(constant_in_step_, context.memory(), profile);
}

void Diagram::derivatives(Context& context, std::span<double> rates, BlockProfile* profile) const {
  run(varying_in_step_, context.memory(), profile);
  run(derivative_calls_, context.memory(), profile);
  auto to = rates.begin();
  for (const StateCell& cell : continuous_cells_) {
    const std::span<double> rate = cell.type->numbers(cell.next->in(context.memory()));
    to = std::copy(rate.begin(), rate.end(), to);
  }
}

Place Diagram::place(PortId port) const {
  if (!layout_.contains(port)) {
    throw SetupError("a port of a block that is not in the diagram '" + name() + "' was asked for");
  }
  return layout_.place(port);
}

void Diagram::collect_taps(const Diagram& diagram, const std::string& prefix, std::vector<Tap>& taps) const {
  for (std::size_t i = 0; i < diagram.outputs().size(); ++i) {
    const PortId port{&diagram, PortId::Kind::output, static_cast<int>(i)};
    taps.push_back({prefix + diagram.outputs()[i].name, port, diagram.outputs()[i].type, place(port), false});
  }
  for (const auto& child : diagram.children_) {
    const std::string inner = prefix + child->name() + "/";
    if (const auto* nested = dynamic_cast<const Diagram*>(child.get())) {
      collect_taps(*nested, inner, taps);
      continue;
    }
    for (std::size_t i = 0; i < child->outputs().size(); ++i) {
      const PortId port{child.get(), PortId::Kind::output, static_cast<int>(i)};
      const Output& output = child->outputs()[i];
      taps.push_back({inner + output.name, port, output.type, place(port), output.intermediate});
    }
  }
}

std::string Diagram::needing_adaptive_steps() const {
  for (const auto& child : children_) {
    if (child->needs_adaptive_steps()) return child->name();
    const auto* nested = dynamic_cast<const Diagram*>(child.get());
    const std::string inner = nested != nullptr ? nested->needing_adaptive_steps() : "";
    if (!inner.empty()) return child->name() + "/" + inner;
  }
  return "";
}

std::vector<Diagram::Tap> Diagram::taps() const {
  std::vector<Tap> taps;
  for (std::size_t i = 0; i < inputs().size(); ++i) {
    const PortId port{this, PortId::Kind::input, static_cast<int>(i)};
    taps.push_back({inputs()[i].name, port, inputs()[i].type, place(port), false});
  }
  collect_taps(*this, "", taps);
  return taps;
}

Diagram::Tap Diagram::tap(const std::string& path) const {
  std::vector<std::string> paths;
  for (Tap& tap : taps()) {
    if (tap.path == path) return tap;
    paths.push_back(std::move(tap.path));
  }
  throw SetupError("the diagram '" + name() + "' has no port '" + path + "'" + did_you_mean(path, paths));
}

std::string Diagram::schedule() const {
  std::string text;
  for (const std::string& line : schedule_lines_) text += line + "\n";
  return text;
}

}  // namespace flinch
