#include "systems/framework/recording.h"

#include <limits>

#include "systems/foundation/nearest_name.h"
#include "systems/foundation/setup_error.h"

namespace flinch {

const Signal& Recording::signal(const std::string& path) const {
  std::vector<std::string> paths;
  for (const Signal& signal : signals) {
    if (signal.path == path) return signal;
    paths.push_back(signal.path);
  }
  throw SetupError("the recording has no signal '" + path + "'" + did_you_mean(path, paths));
}

std::vector<double> Recording::column(const std::string& path, const std::string& field, int element) const {
  const Signal& found = signal(path);
  std::size_t first = 0;
  std::vector<std::string> names;
  for (const Field& each : found.layout.fields) {
    const std::size_t header = each.resizable ? 2 : 0;
    if (each.name != field) {
      names.push_back(each.name);
      first += header + static_cast<std::size_t>(each.capacity);
      continue;
    }
    std::vector<double> values(samples(), std::numeric_limits<double>::quiet_NaN());
    for (std::size_t k = 0; k < values.size(); ++k) {
      const internal::Number* row = found.rows.data() + k * found.layout.numbers + first;
      const std::int64_t size = each.resizable ? row[0].integer * row[1].integer : each.capacity;
      if (element >= size) continue;
      const internal::Number number = row[header + static_cast<std::size_t>(element)];
      values[k] = each.kind == Field::Kind::real ? number.real : static_cast<double>(number.integer);
    }
    return values;
  }
  throw SetupError("the signal '" + path + "' has no field '" + field + "'" + did_you_mean(field, names));
}

}  // namespace flinch
