#include "import/numpy_log.h"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>
#include <map>
#include <utility>

#include "import/byte_order.h"
#include "systems/foundation/problems_of_place.h"
#include "systems/foundation/setup_error.h"

namespace flinch {
namespace {

constexpr std::string_view magic = "\x93NUMPY";
constexpr std::size_t most_columns = 1000;  // of an array
constexpr std::uint64_t most_head = 1U << 16U;
constexpr std::uint64_t most_numbers = std::uint64_t{1} << 40U;

/// What stands behind 'key': in the text of a dictionary.
std::string_view value_of(std::string_view text, std::string_view key) {
  const std::size_t at = text.find(key);
  if (at == std::string_view::npos)
    throw SetupError("its head is broken: " + std::string(key) + " is missing");
  std::string_view rest = text.substr(at + key.size());
  rest.remove_prefix(std::min(rest.find_first_not_of(": "), rest.size()));
  return rest;
}

std::vector<std::size_t> dimensions_of(std::string_view text) {
  std::vector<std::size_t> dimensions;
  text = text.substr(0, text.find(')'));
  for (std::size_t i = 0; i < text.size();) {
    if (text[i] < '0' || text[i] > '9') {
      ++i;
      continue;
    }
    std::size_t number = 0;
    const auto [end, error] = std::from_chars(text.data() + i, text.data() + text.size(), number);
    if (error != std::errc{}) throw SetupError("its head is broken: a dimension is no number");
    dimensions.push_back(number);
    i = static_cast<std::size_t>(end - text.data());
  }
  return dimensions;
}

void set_type(std::string_view descr, NumpyShape& shape) {
  if (!descr.starts_with('\''))
    throw SetupError("its numbers are of several types; save each field by itself");
  const std::string_view type = descr.substr(1, descr.find('\'', 1) - 1);
  const std::string refused =
      "its type is '" + std::string(type) + "', which is no number of at most 64 bits";
  if (type.size() < 3) throw SetupError(refused);
  shape.is_big = type[0] == '>';
  shape.kind = type[1];
  const auto [end, error] = std::from_chars(type.data() + 2, type.data() + type.size(), shape.width);
  const bool is_real = shape.kind == 'f' && (shape.width == 4 || shape.width == 8);
  const bool is_whole = std::string_view("iubM").find(shape.kind) != std::string_view::npos &&
                        std::has_single_bit(shape.width) && shape.width <= 8;
  if (error != std::errc{} || (!is_real && !is_whole)) throw SetupError(refused);
  if (shape.kind == 'M') {
    const std::string_view unit = type.substr(static_cast<std::size_t>(end - type.data()));
    if (unit.size() > 2) shape.unit = unit.substr(1, unit.size() - 2);
  }
}

std::uint64_t raw_number(const char* bytes, const NumpyShape& shape) {
  return number_of_bytes({bytes, shape.width}, shape.is_big);
}

std::int64_t whole_number(const char* bytes, const NumpyShape& shape) {
  const std::uint64_t number = raw_number(bytes, shape);
  if (shape.kind == 'u' || shape.kind == 'b' || shape.width == 8) return static_cast<std::int64_t>(number);
  const std::uint64_t sign = std::uint64_t{1} << (8 * shape.width - 1);
  return static_cast<std::int64_t>(number ^ sign) - static_cast<std::int64_t>(sign);
}

double number(const char* bytes, const NumpyShape& shape) {
  if (shape.kind == 'f') {
    const std::uint64_t raw = raw_number(bytes, shape);
    const double value = shape.width == 8 ? std::bit_cast<double>(raw)
                                          : double{std::bit_cast<float>(static_cast<std::uint32_t>(raw))};
    return std::isfinite(value) ? value : std::nan("");
  }
  if (shape.kind == 'u') return static_cast<double>(raw_number(bytes, shape));
  const std::int64_t value = whole_number(bytes, shape);
  if (shape.kind == 'M' && value == std::numeric_limits<std::int64_t>::min()) return std::nan("");  // no time
  return static_cast<double>(value);
}

/// Where the number of a row and a column begins.
std::size_t place_of(const NumpyShape& shape, std::size_t row, std::size_t column) {
  const bool rows_run_fastest = shape.columns == 1 || shape.is_wide != shape.is_fortran;
  const std::size_t index = rows_run_fastest ? column * shape.rows + row : row * shape.columns + column;
  return shape.head + index * shape.width;
}

}  // namespace

NumpyShape numpy_shape(const std::string& bytes) {
  if (!bytes.starts_with(magic) || bytes.size() < 12) throw SetupError("it is no array of NumPy");
  NumpyShape shape;
  const auto byte = [&](std::size_t i) {
    return static_cast<std::size_t>(static_cast<unsigned char>(bytes[i]));
  };
  const bool is_long = byte(6) >= 2;
  const std::size_t length =
      byte(8) + (byte(9) << 8U) + (is_long ? (byte(10) << 16U) + (byte(11) << 24U) : 0);
  shape.head = (is_long ? 12U : 10U) + length;
  if (shape.head > bytes.size()) throw SetupError("its head is cut");
  const std::string_view text = std::string_view(bytes).substr(is_long ? 12 : 10, length);
  set_type(value_of(text, "'descr'"), shape);
  shape.is_fortran = value_of(text, "'fortran_order'").starts_with("True");
  const std::vector<std::size_t> dimensions = dimensions_of(value_of(text, "'shape'"));
  if (dimensions.empty() || dimensions.size() > 2)
    throw SetupError("it has " + std::to_string(dimensions.size()) + " dimensions; a table has 1 or 2");
  shape.rows = dimensions[0];
  if (dimensions.size() == 2) {
    shape.is_wide = dimensions[1] > dimensions[0];
    shape.rows = std::max(dimensions[0], dimensions[1]);
    shape.columns = std::min(dimensions[0], dimensions[1]);
  }
  if (shape.rows > most_numbers || shape.columns > most_columns)
    throw SetupError("it has " + std::to_string(shape.rows) + " x " + std::to_string(shape.columns) +
                     " numbers");
  return shape;
}

bool is_numpy(const std::filesystem::path& file) {
  std::string head(magic.size(), '\0');
  std::ifstream stream(file, std::ios::binary);
  stream.read(head.data(), static_cast<std::streamsize>(head.size()));
  return stream && head == magic;
}

NumpyLog::NumpyLog(const std::filesystem::path& file) {
  file_ = file;
  const auto take = [&](Array array) {
    try {
      array.shape = numpy_shape(bytes_of(array, most_head));
      const std::uint64_t size =
          array.entry ? array.entry->size : static_cast<std::uint64_t>(std::filesystem::file_size(file_));
      if (array.shape.head + array.shape.rows * array.shape.columns * array.shape.width > size)
        throw SetupError("it is cut");
      if (array.shape.rows > 0 && array.shape.columns > 0) add(std::move(array));
    } catch (const SetupError& error) {
      remarks_.push_back("the array '" + array.name + "': " + error.what() + "; left out");
    }
  };
  if (is_numpy(file)) {
    take({file.stem().string(), std::nullopt, {}});
  } else {
    for (const ZipEntry& entry : out_of(file.string(), [&] { return zip_entries(file); })) {
      if (entry.name.ends_with(".npy")) take({entry.name.substr(0, entry.name.size() - 4), entry, {}});
    }
  }
  throw_if_empty("array of numbers that can be read");
}

void NumpyLog::add(Array array) {
  const NumpyShape& shape = array.shape;
  for (std::size_t i = 0; i < shape.columns; ++i) {
    columns_.push_back({.name = shape.columns == 1 ? array.name : array.name + "[" + std::to_string(i) + "]",
                        .unit = shape.unit,
                        .table = std::to_string(shape.rows),
                        .rows = shape.rows});
    places_.push_back({arrays_.size(), i});
  }
  arrays_.push_back(std::move(array));
}

std::string NumpyLog::bytes_of(const Array& array, std::uint64_t most) const {
  if (array.entry) return unzipped(file_, *array.entry, most);
  std::ifstream stream(file_, std::ios::binary);
  std::string bytes(std::min<std::uint64_t>(most, std::filesystem::file_size(file_)), '\0');
  stream.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  if (!stream) throw SetupError("the file cannot be read");
  return bytes;
}

std::string NumpyLog::whole(const Array& array) const {
  return out_of(file_.string(), [&] { return bytes_of(array, UINT64_MAX); });
}

std::vector<std::vector<double>> NumpyLog::read(std::span<const std::size_t> wanted, std::size_t most_rows) {
  std::vector<std::vector<double>> numbers;
  std::map<std::size_t, std::string> known;
  for (const std::size_t column : wanted) {
    const Place& place = places_[column];
    const Array& array = arrays_[place.array];
    auto bytes = known.find(place.array);
    if (bytes == known.end()) bytes = known.emplace(place.array, whole(array)).first;
    std::vector<double>& values = numbers.emplace_back(std::min(array.shape.rows, most_rows));
    for (std::size_t k = 0; k < values.size(); ++k)
      values[k] = number(bytes->second.data() + place_of(array.shape, k, place.column), array.shape);
  }
  return numbers;
}

std::vector<std::int64_t> NumpyLog::read_instants(std::size_t column, ClockUnit unit, std::size_t most_rows) {
  const Place& place = places_[column];
  const Array& array = arrays_[place.array];
  if (array.shape.kind == 'f') return instants_of_numbers(column, unit, most_rows);
  static const std::map<std::string, ClockUnit> told = {
      {"ns", ClockUnit::ns}, {"us", ClockUnit::us}, {"ms", ClockUnit::ms}, {"s", ClockUnit::s}};
  const auto own = told.find(array.shape.unit);
  const auto factor = static_cast<std::int64_t>(own == told.end() ? unit : own->second);
  const std::string bytes = whole(array);
  std::vector<std::int64_t> instants;
  for (std::size_t k = 0; k < std::min(array.shape.rows, most_rows); ++k) {
    const std::int64_t value =
        whole_number(bytes.data() + place_of(array.shape, k, place.column), array.shape);
    const bool fits = std::abs(static_cast<double>(value)) * static_cast<double>(factor) < 9e18;
    instants.push_back(fits ? value * factor : no_instant);
  }
  return instants;
}

}  // namespace flinch
