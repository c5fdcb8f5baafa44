#include "systems/framework/recording.h"

#include <algorithm>
#include <limits>

#include "systems/foundation/nearest_name.h"
#include "systems/foundation/setup_error.h"
#include "systems/framework/recording_check.h"

namespace flinch {
namespace {

/// Where a field lies in a row.
struct FieldPlace {
  const Field& field;
  std::size_t first;  ///< number of the row, its rows and columns included where it is resizable
};

FieldPlace place_of(const Signal& signal, const std::string& name) {
  std::size_t first = 0;
  std::vector<std::string> names;
  for (const Field& field : signal.layout.fields) {
    if (field.name == name) return {field, first};
    names.push_back(field.name);
    first += static_cast<std::size_t>(field.capacity) + (field.resizable ? 2U : 0U);
  }
  throw SetupError("the signal '" + signal.path + "' has no field '" + name + "'" +
                   did_you_mean(name, names));
}

/// One number of a row as a real number; NaN where the field is shorter.
double number_at(const internal::Number* row, const FieldPlace& place, int element) {
  const internal::Number* const numbers = row + place.first;
  const std::int64_t size = place.field.resizable
                                ? internal::checked_size(numbers[0].integer, numbers[1].integer,
                                                         place.field.capacity, place.field.name)
                                : place.field.capacity;
  if (element < 0 || element >= size) return std::numeric_limits<double>::quiet_NaN();
  const internal::Number number = numbers[(place.field.resizable ? 2 : 0) + element];
  return place.field.kind == Field::Kind::real ? number.real : static_cast<double>(number.integer);
}

}  // namespace

const Signal* Recording::find(const std::string& path) const {
  const auto found =
      std::find_if(signals.begin(), signals.end(), [&path](const Signal& each) { return each.path == path; });
  return found == signals.end() ? nullptr : &*found;
}

const Signal& Recording::signal(const std::string& path) const {
  if (const Signal* const found = find(path)) return *found;
  std::vector<std::string> paths;
  for (const Signal& each : signals) paths.push_back(each.path);
  throw SetupError("the recording has no signal '" + path + "'" + did_you_mean(path, paths));
}

std::shared_ptr<const RowSource::Rows> RowSource::shared(const std::string& path, std::size_t first,
                                                         std::size_t count, std::size_t width) const {
  const std::lock_guard lock(mutex_);
  Last& last = last_[path];
  std::shared_ptr<const Rows> held = last.rows.lock();
  if (held != nullptr && last.first == first && held->size() == count * width) return held;
  auto rows = std::make_shared<Rows>(count * width);
  read(path, first, count, rows->data());
  last = {first, rows};
  return rows;
}

void Recording::read_rows(const Signal& signal, std::size_t first, std::size_t count,
                          internal::Number* rows) const {
  if (signal.rows.empty() && source != nullptr) {
    source->read(signal.path, first, count, rows);
  } else {
    std::copy_n(signal.rows.data() + first * signal.layout.numbers, count * signal.layout.numbers, rows);
  }
}

std::shared_ptr<const RowSource::Rows> Recording::shared_rows(const Signal& signal, std::size_t first,
                                                              std::size_t count) const {
  if (source == nullptr) throw SetupError("the signal '" + signal.path + "' has no samples");
  return source->shared(signal.path, first, count, signal.layout.numbers);
}

std::vector<double> Recording::column(const std::string& path, const std::string& field, int element) const {
  const Signal& found = signal(path);
  const FieldPlace place = place_of(found, field);
  std::vector<double> values;
  values.reserve(samples());
  std::vector<internal::Number> rows(std::min(block, samples()) * found.layout.numbers);
  for (std::size_t first = 0; first < samples(); first += block) {
    const std::size_t count = std::min(block, samples() - first);
    read_rows(found, first, count, rows.data());
    for (std::size_t k = 0; k < count; ++k) {
      values.push_back(number_at(rows.data() + k * found.layout.numbers, place, element));
    }
  }
  return values;
}

void Recording::append(const SampleBlock& samples) {
  time_ns.insert(time_ns.end(), samples.time_ns.begin(), samples.time_ns.end());
  for (std::size_t i = 0; i < signals.size(); ++i) {
    std::vector<internal::Number>& rows = signals[i].rows;
    for (std::size_t k = 0; k < samples.samples(); ++k) {
      const std::span<const internal::Number> row = samples.rows[i][k];
      rows.insert(rows.end(), row.begin(), row.end());
    }
  }
}

}  // namespace flinch
