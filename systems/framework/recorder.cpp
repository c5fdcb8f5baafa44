#include "systems/framework/recorder.h"

#include <algorithm>

#include "systems/foundation/nearest_name.h"
#include "systems/foundation/setup_error.h"
#include "systems/framework/context.h"

namespace flinch {
namespace {

/// Gives every field that names a quantity the unit of that quantity.
void resolve_units(const UnitTable& units, Signal& signal, std::vector<std::string>& problems) {
  for (Field& field : signal.layout.fields) {
    if (!field.unit.starts_with('<')) continue;
    if (const auto found = units.find(field.unit); found != units.end()) {
      field.unit = found->second;
      continue;
    }
    std::vector<std::string> names;
    for (const auto& [name, unit] : units) names.push_back(name);
    problems.push_back("the field '" + field.name + "' of the port '" + signal.path +
                       "' has the unit of the quantity " + field.unit +
                       ", which is not in the table of units that the recorder was given" +
                       did_you_mean(field.unit, names));
  }
}

/// Asks for the memory of a sample before it is written: nobody has touched it for a whole ring, and who
/// writes it would wait for one line of it after the other.
void fetch(const internal::Number* sample, std::size_t numbers) {
  constexpr std::size_t line = 64 / sizeof(internal::Number);
  for (std::size_t i = 0; i < numbers; i += line) __builtin_prefetch(sample + i, 1);
}

}  // namespace

Recorder::Recorder(const Diagram& diagram, const std::vector<std::string>& paths, std::size_t capacity,
                   const UnitTable& units, Every every)
    : every_(every), capacity_(capacity) {
  if (every_.period == Time::zero()) every_.period = diagram.tick();
  std::vector<std::string> problems;
  for (const std::string& path : paths) {
    try {
      const Diagram::Tap tap = diagram.tap(path);
      if (tap.type->layout == nullptr) {
        problems.push_back("the port '" + path +
                           "' cannot be recorded: its type has no fields (see fields.h)");
        continue;
      }
      Signal signal{path, tap.type->layout(), {}};
      resolve_units(units, signal, problems);
      shown_.push_back({std::move(signal), channel_of(tap)});
    } catch (const SetupError& error) {
      problems.insert(problems.end(), error.problems().begin(), error.problems().end());
    }
  }
  throw_if_any(std::move(problems));
  time_ns_.resize(capacity);
  rows_.resize(capacity * numbers_);
}

std::size_t Recorder::channel_of(const Diagram::Tap& tap) {
  for (std::size_t i = 0; i < channels_.size(); ++i) {
    if (channels_[i].place == tap.place) return i;
  }
  const std::size_t numbers = tap.type->layout().numbers;
  channels_.push_back({tap.place, tap.type, numbers_, numbers});
  numbers_ += numbers;
  return channels_.size() - 1;
}

void Recorder::record(const Context& context) {
  if (!context.due(every_)) return;
  const std::size_t pushed = pushed_.load(std::memory_order_relaxed);
  if (pushed - popped_.load(std::memory_order_acquire) == capacity_) {
    dropped_.fetch_add(1, std::memory_order_relaxed);
    return;
  }
  const std::size_t slot = pushed % capacity_;
  time_ns_[slot] = context.time().count();
  internal::Number* const sample = rows_.data() + slot * numbers_;
  for (const Channel& channel : channels_)
    channel.type->to_row(channel.place.in(context.memory()), sample + channel.first);
  fetch(rows_.data() + (pushed + 1) % capacity_ * numbers_, numbers_);
  pushed_.store(pushed + 1, std::memory_order_release);
}

void Recorder::clear() {
  pushed_ = popped_ = 0;
  dropped_ = 0;
}

SampleBlock Recorder::block(std::size_t first, std::size_t samples) const {
  SampleBlock block{std::span(time_ns_).subspan(first, samples), {}};
  for (const Shown& shown : shown_) {
    const Channel& channel = channels_[shown.channel];
    block.rows.push_back({rows_.data() + first * numbers_ + channel.first, channel.numbers, numbers_});
  }
  return block;
}

SampleBlock Recorder::front() const {
  const std::size_t waiting = samples();
  const std::size_t first = waiting == 0 ? 0 : popped_.load(std::memory_order_relaxed) % capacity_;
  return block(first, std::min(waiting, capacity_ - first));
}

void Recorder::pop(std::size_t samples) { popped_.fetch_add(samples, std::memory_order_release); }

Recording Recorder::description(std::map<std::string, std::string> attributes) const {
  Recording recording{every_.period, {}, std::move(attributes), {}, nullptr};
  for (const Shown& shown : shown_) recording.signals.push_back(shown.signal);
  return recording;
}

Recording Recorder::recording(std::map<std::string, std::string> attributes) const {
  Recording recording = description(std::move(attributes));
  const SampleBlock oldest = front();
  recording.append(oldest);
  recording.append(block(0, samples() - oldest.samples()));  // what lies beyond the end of the ring
  return recording;
}

std::vector<std::string> recordable_paths(const Diagram& diagram) {
  std::vector<std::string> paths;
  for (Diagram::Tap& tap : diagram.taps()) {
    if (tap.type->layout != nullptr && !tap.intermediate) paths.push_back(std::move(tap.path));
  }
  return paths;
}

}  // namespace flinch
