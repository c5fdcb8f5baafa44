#include "export/exported_signal.h"

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <string_view>

#include "systems/foundation/json_text.h"

namespace flinch {
namespace {

using internal::Number;

/// "N, N, Nm" as a list.
std::vector<std::string> listed(const std::string& units) {
  std::vector<std::string> list;
  for (std::size_t begin = 0; begin <= units.size();) {
    const std::size_t end = std::min(units.find(", ", begin), units.size());
    list.push_back(units.substr(begin, end - begin));
    begin = end + 2;
  }
  return list;
}

constexpr std::array<std::string_view, 4> quaternion_names = {"qw", "qx", "qy", "qz"};

/// Of a coordinate along an axis.
bool is_linear(std::string_view unit) {
  return unit == "m" || unit == "m/s" || unit == "m/s^2" || unit == "N";
}

/// Names of coordinates of a platform, translations first: of forces "fx", of moments "mx".
std::vector<std::string> coordinates(const std::vector<std::string>& units) {
  const std::string axes = "xyz";
  const auto lines = static_cast<std::size_t>(std::count_if(units.begin(), units.end(), is_linear));
  const std::size_t turns = units.size() - lines;
  std::vector<std::string> names;
  for (std::size_t i = 0; i < units.size(); ++i) {
    const std::size_t turn = i - std::min(i, lines);
    const bool is_wrench = units[i] == "N" || units[i] == "Nm";
    if (i < lines && i < axes.size()) {
      names.push_back((is_wrench ? "f" : "") + axes.substr(i, 1));
    } else if (units[i] == "1" && turns == quaternion_names.size()) {
      names.emplace_back(quaternion_names[turn]);
    } else if (turns == 1) {
      names.emplace_back(is_wrench ? "mz" : "phi");
    } else {
      names.push_back((is_wrench ? "m" : "r") + axes.substr(std::min<std::size_t>(turn, 2), 1));
    }
  }
  return names;
}

std::vector<std::string> numbered(std::size_t count) {
  std::vector<std::string> names;
  for (std::size_t i = 1; i <= count; ++i) names.push_back(std::to_string(i));
  return names;
}

/// Those of the numbers of a field that is a column or a row, or one number.
std::vector<std::string> names_of(const Field& field, const std::vector<std::string>& units,
                                  std::size_t width) {
  if (field.capacity == 1 && !field.resizable) return {""};
  const bool is_spatial = !field.frame.empty();
  if (is_spatial && units.size() == width && width > 1) return coordinates(units);
  if (is_spatial && width <= 3 && units.size() == 1) {
    std::vector<std::string> axes = {"x", "y", "z"};
    axes.resize(width);
    return axes;
  }
  return numbered(width);
}

/// The largest size that a field ever had.
struct LargestSize {
  std::int64_t rows = 0, columns = 0, numbers = 0;

  void hold(const Number* size) {
    rows = std::max(rows, size[0].integer);
    columns = std::max(columns, size[1].integer);
    numbers = std::max(numbers, size[0].integer * size[1].integer);
  }
};

/// "2_1" of a matrix, whose numbers lie column by column.
std::vector<std::string> of_matrix(const LargestSize& size) {
  std::vector<std::string> names;
  for (std::int64_t column = 1; column <= size.columns; ++column) {
    for (std::int64_t row = 1; row <= size.rows; ++row)
      names.push_back(std::to_string(row) + "_" + std::to_string(column));
  }
  return names;
}

void name_numbers(const Field& field, const LargestSize& size, ExportedField& exported) {
  const bool is_matrix = field.resizable && size.rows > 1 && size.columns > 1;
  std::vector<std::string> units = listed(field.unit);
  const std::size_t width =
      field.resizable ? static_cast<std::size_t>(std::min<std::int64_t>(size.numbers, field.capacity))
                      : static_cast<std::size_t>(field.capacity);
  exported.components = is_matrix && static_cast<std::size_t>(size.rows * size.columns) == width
                            ? of_matrix(size)
                            : names_of(field, units, width);
  units.resize(std::max(width, units.size()), units.size() == 1 ? units.front() : "");
  units.resize(width);
  exported.units = std::move(units);
}

std::vector<LargestSize> sizes_of(const Recording& recording, const Signal& signal,
                                  const std::vector<std::size_t>& places) {
  std::vector<LargestSize> sizes(places.size());
  for_each_block(recording, signal, [&](std::size_t, std::size_t count, const Number* rows) {
    for (std::size_t k = 0; k < count; ++k) {
      for (std::size_t i = 0; i < places.size(); ++i)
        sizes[i].hold(rows + k * signal.layout.numbers + places[i]);
    }
  });
  return sizes;
}

ExportedSignal exported(const Recording& recording, const Signal& signal) {
  ExportedSignal result{signal.path, &signal, {}, {}};
  std::vector<std::size_t> firsts, sized;  // of all fields; of the sizes of those that have one
  std::size_t next = 0;
  for (const Field& field : signal.layout.fields) {
    if (field.resizable) {
      sized.push_back(next);
      next += 2;
    }
    firsts.push_back(next);
    next += static_cast<std::size_t>(field.capacity);
  }
  const std::vector<LargestSize> sizes =
      sized.empty() ? std::vector<LargestSize>{} : sizes_of(recording, signal, sized);
  auto size = sizes.begin();
  for (std::size_t i = 0; i < firsts.size(); ++i) {
    const Field& field = signal.layout.fields[i];
    ExportedField one{field.name, field.kind, field.frame, firsts[i], field.resizable, {}, {}};
    name_numbers(field, field.resizable ? *size++ : LargestSize{}, one);
    if (one.width() > 0)
      result.fields.push_back(std::move(one));
    else
      result.left_out.push_back(field.name);
  }
  return result;
}

}  // namespace

std::string ExportedField::column(std::size_t component) const {
  return components[component].empty() ? name : name + "_" + components[component];
}

std::size_t ExportedField::numbers_in(const Number* row) const {
  if (!resizable) return width();
  const std::int64_t numbers = row[first - 2].integer * row[first - 1].integer;
  return static_cast<std::size_t>(std::clamp<std::int64_t>(numbers, 0, static_cast<std::int64_t>(width())));
}

std::vector<ExportedSignal> exported_signals(const Recording& recording,
                                             const std::vector<std::string>& names) {
  std::vector<ExportedSignal> signals;
  if (names.empty()) {
    for (const Signal& signal : recording.signals) signals.push_back(exported(recording, signal));
  }
  for (const std::string& name : names) signals.push_back(exported(recording, recording.signal(name)));
  return signals;
}

void for_each_block(const Recording& recording, const Signal& signal, const TakeRows& take) {
  std::vector<Number> rows(Recording::block * signal.layout.numbers);
  for (std::size_t first = 0; first < recording.samples(); first += Recording::block) {
    const std::size_t count = std::min(Recording::block, recording.samples() - first);
    recording.read_rows(signal, first, count, rows.data());
    take(first, count, rows.data());
  }
}

std::string description_json(const Recording& recording, const std::vector<ExportedSignal>& signals) {
  using Json = nlohmann::ordered_json;
  Json all = Json::object();
  for (const ExportedSignal& signal : signals) {
    Json fields = Json::object();
    for (const ExportedField& field : signal.fields) {
      const bool is_one = field.components.front().empty();
      fields[field.name] = {{"unit", is_one ? Json(field.units.front()) : Json(field.units)},
                            {"components", is_one ? Json::array() : Json(field.components)},
                            {"frame", field.frame}};
    }
    all[signal.path] = std::move(fields);
  }
  return json_text(Json{{"period_ns", recording.period.count()}, {"signals", all}});
}

}  // namespace flinch
