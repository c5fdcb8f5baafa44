// write_recording() and read_recording(): the HDF5 side of Recording.
#include <hdf5.h>

#include <algorithm>
#include <functional>
#include <limits>
#include <system_error>
#include <utility>

#include "systems/foundation/setup_error.h"
#include "systems/framework/recording.h"

namespace flinch {
namespace {

using internal::Number;

/// An HDF5 identifier that closes itself; a failed call throws SetupError saying what was being done.
class Handle {
 public:
  Handle(hid_t id, herr_t (*close)(hid_t), const std::string& doing) : id_(id), close_(close) {
    if (id_ < 0) throw SetupError("HDF5 failed " + doing);
  }
  Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, -1)), close_(other.close_) {}
  Handle& operator=(Handle&&) = delete;
  ~Handle() {
    if (id_ >= 0) close_(id_);
  }
  operator hid_t() const { return id_; }  // NOLINT(google-explicit-constructor): it stands for the identifier

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

void check(herr_t status, const std::string& doing) {
  if (status < 0) throw SetupError("HDF5 failed " + doing);
}

void silence_hdf5() { H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr); }

// --- attributes ---

Handle text_type(std::size_t size) {
  Handle type(H5Tcopy(H5T_C_S1), H5Tclose, "making a text type");
  check(H5Tset_size(type, std::max<std::size_t>(size, 1)), "sizing a text");
  check(H5Tset_cset(type, H5T_CSET_UTF8), "encoding a text");
  return type;
}

void write_text(hid_t object, const std::string& name, const std::string& text) {
  const Handle type = text_type(text.size());
  const Handle space(H5Screate(H5S_SCALAR), H5Sclose, "making an attribute");
  const Handle attribute(H5Acreate2(object, name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose,
                         "making the attribute '" + name + "'");
  const std::string padded = text.empty() ? std::string(1, '\0') : text;
  check(H5Awrite(attribute, type, padded.data()), "writing the attribute '" + name + "'");
}

void write_integer(hid_t object, const std::string& name, std::int64_t value) {
  const Handle space(H5Screate(H5S_SCALAR), H5Sclose, "making an attribute");
  const Handle attribute(H5Acreate2(object, name.c_str(), H5T_STD_I64LE, space, H5P_DEFAULT, H5P_DEFAULT),
                         H5Aclose, "making the attribute '" + name + "'");
  check(H5Awrite(attribute, H5T_NATIVE_INT64, &value), "writing the attribute '" + name + "'");
}

Handle open_attribute(hid_t object, const std::string& name) {
  return {H5Aopen(object, name.c_str(), H5P_DEFAULT), H5Aclose, "opening the attribute '" + name + "'"};
}

std::string read_text(hid_t object, const std::string& name) {
  const Handle attribute = open_attribute(object, name);
  const Handle type(H5Aget_type(attribute), H5Tclose, "reading the type of '" + name + "'");
  if (H5Tget_class(type) != H5T_STRING || H5Tis_variable_str(type) > 0) {
    throw SetupError("the attribute '" + name + "' is no text of fixed length");
  }
  std::string text(H5Tget_size(type), '\0');
  check(H5Aread(attribute, type, text.data()), "reading the attribute '" + name + "'");
  while (!text.empty() && text.back() == '\0') text.pop_back();
  return text;
}

std::int64_t read_integer(hid_t object, const std::string& name) {
  const Handle attribute = open_attribute(object, name);
  std::int64_t value = 0;
  check(H5Aread(attribute, H5T_NATIVE_INT64, &value), "reading the attribute '" + name + "'");
  return value;
}

// --- data sets ---

hid_t file_type(Field::Kind kind) {
  if (kind == Field::Kind::real) return H5T_IEEE_F64LE;
  return kind == Field::Kind::boolean ? H5T_STD_U8LE : H5T_STD_I64LE;
}

hid_t memory_type(Field::Kind kind) {
  return kind == Field::Kind::real ? H5T_NATIVE_DOUBLE : H5T_NATIVE_INT64;
}

/// Creation properties without time stamps, and compressed where there is enough to compress.
Handle properties(hsize_t samples, hsize_t columns) {
  Handle list(H5Pcreate(H5P_DATASET_CREATE), H5Pclose, "making data set properties");
  check(H5Pset_obj_track_times(list, false), "leaving out time stamps");
  if (samples >= 64) {
    const hsize_t chunk[2] = {std::min<hsize_t>(samples, 4096), columns};
    check(H5Pset_chunk(list, 2, chunk), "chunking");
    check(H5Pset_shuffle(list), "shuffling");
    check(H5Pset_deflate(list, 1), "compressing");
  }
  return list;
}

Handle write_numbers(hid_t parent, const std::string& name, Field::Kind kind,
                     const std::vector<Number>& numbers, std::size_t samples) {
  const hsize_t columns = samples == 0 ? 1 : numbers.size() / samples;
  const hsize_t size[2] = {samples, columns};
  const Handle space(H5Screate_simple(2, size, nullptr), H5Sclose, "making a data space");
  const Handle creation = properties(samples, columns);
  Handle set(H5Dcreate2(parent, name.c_str(), file_type(kind), space, H5P_DEFAULT, creation, H5P_DEFAULT),
             H5Dclose, "making the data set '" + name + "'");
  check(H5Dwrite(set, memory_type(kind), H5S_ALL, H5S_ALL, H5P_DEFAULT, numbers.data()),
        "writing the data set '" + name + "'");
  return set;
}

std::vector<Number> read_numbers(hid_t parent, const std::string& name, Field::Kind kind, std::size_t samples,
                                 std::size_t columns) {
  const Handle set(H5Dopen2(parent, name.c_str(), H5P_DEFAULT), H5Dclose,
                   "opening the data set '" + name + "'");
  const Handle space(H5Dget_space(set), H5Sclose, "reading the size of '" + name + "'");
  hsize_t size[2] = {0, 0};
  if (H5Sget_simple_extent_ndims(space) != 2 || H5Sget_simple_extent_dims(space, size, nullptr) != 2 ||
      size[0] != samples || (samples > 0 && size[1] != columns)) {
    throw SetupError("the data set '" + name + "' has " + std::to_string(size[0]) + " x " +
                     std::to_string(size[1]) + " numbers instead of " + std::to_string(samples) + " x " +
                     std::to_string(columns));
  }
  std::vector<Number> numbers(samples * columns);
  check(H5Dread(set, memory_type(kind), H5S_ALL, H5S_ALL, H5P_DEFAULT, numbers.data()),
        "reading the data set '" + name + "'");
  return numbers;
}

// --- signals ---

/// Columns first ... first + count of every row of `signal`.
std::vector<Number> columns_of(const Signal& signal, std::size_t samples, std::size_t first,
                               std::size_t count) {
  std::vector<Number> columns;
  columns.reserve(samples * count);
  for (std::size_t k = 0; k < samples; ++k) {
    const Number* row = signal.rows.data() + k * signal.layout.numbers + first;
    columns.insert(columns.end(), row, row + count);
  }
  return columns;
}

void put_columns(Signal& signal, const std::vector<Number>& columns, std::size_t samples, std::size_t first) {
  const std::size_t count = samples == 0 ? 0 : columns.size() / samples;
  for (std::size_t k = 0; k < samples; ++k) {
    std::copy_n(columns.data() + k * count, count, signal.rows.data() + k * signal.layout.numbers + first);
  }
}

/// Properties of groups or files without time stamps; `kind` is H5P_GROUP_CREATE or H5P_FILE_CREATE.
Handle timeless(hid_t kind) {
  Handle list(H5Pcreate(kind), H5Pclose, "making properties");
  check(H5Pset_obj_track_times(list, false), "leaving out time stamps");
  return list;
}

/// Opens the group `path`; it and those around it are made where they are missing.
Handle make_group(hid_t file, const std::string& path) {
  const Handle creation = timeless(H5P_GROUP_CREATE);
  const std::string doing = "making the group '" + path + "'";
  for (std::size_t end = path.find('/');; end = path.find('/', end + 1)) {
    const std::string part = path.substr(0, end);
    if (H5Lexists(file, part.c_str(), H5P_DEFAULT) <= 0) {
      Handle group(H5Gcreate2(file, part.c_str(), H5P_DEFAULT, creation, H5P_DEFAULT), H5Gclose, doing);
      if (end == std::string::npos) return group;
    } else if (end == std::string::npos) {
      return {H5Gopen2(file, part.c_str(), H5P_DEFAULT), H5Gclose, doing};
    }
  }
}

void write_signal(hid_t file, const Signal& signal, std::size_t samples, Time period) {
  const Handle group = make_group(file, signal.path);
  write_integer(group, "period_ns", period.count());
  std::string order;
  std::size_t first = 0;
  for (const Field& field : signal.layout.fields) {
    if (field.resizable) {
      write_numbers(group, field.name + ".size", Field::Kind::integer, columns_of(signal, samples, first, 2),
                    samples);
      first += 2;
    }
    const auto capacity = static_cast<std::size_t>(field.capacity);
    const Handle set =
        write_numbers(group, field.name, field.kind, columns_of(signal, samples, first, capacity), samples);
    first += capacity;
    write_text(set, "unit", field.unit);
    write_text(set, "frame", field.frame);
    write_integer(set, "kind", static_cast<std::int64_t>(field.kind));
    write_integer(set, "capacity", field.capacity);
    write_integer(set, "resizable", field.resizable ? 1 : 0);
    order += (order.empty() ? "" : "\n") + field.name;
  }
  write_text(group, "fields", order);
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    lines.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return lines;
}

Field read_field(hid_t group, const std::string& name) {
  const Handle set(H5Dopen2(group, name.c_str(), H5P_DEFAULT), H5Dclose,
                   "opening the data set '" + name + "'");
  Field field{
      name, read_text(set, "unit"), read_text(set, "frame"), {}, 0, read_integer(set, "resizable") != 0};
  field.kind = static_cast<Field::Kind>(std::clamp<std::int64_t>(read_integer(set, "kind"), 0, 2));
  field.capacity = static_cast<int>(std::clamp<std::int64_t>(read_integer(set, "capacity"), 1, 1 << 20));
  return field;
}

Signal read_signal(hid_t file, const std::string& path, std::size_t samples) {
  const Handle group(H5Gopen2(file, path.c_str(), H5P_DEFAULT), H5Gclose, "opening the group '" + path + "'");
  Signal signal{path, {}, {}};
  for (const std::string& name : lines_of(read_text(group, "fields"))) {
    signal.layout.fields.push_back(read_field(group, name));
    const Field& field = signal.layout.fields.back();
    signal.layout.numbers += static_cast<std::size_t>(field.capacity) + (field.resizable ? 2U : 0U);
  }
  signal.rows.resize(samples * signal.layout.numbers);
  std::size_t first = 0;
  for (const Field& field : signal.layout.fields) {
    if (field.resizable) {
      put_columns(signal, read_numbers(group, field.name + ".size", Field::Kind::integer, samples, 2),
                  samples, first);
      first += 2;
    }
    const auto capacity = static_cast<std::size_t>(field.capacity);
    put_columns(signal, read_numbers(group, field.name, field.kind, samples, capacity), samples, first);
    first += capacity;
  }
  return signal;
}

std::vector<std::string> attribute_names(hid_t object) {
  std::vector<std::string> names;
  const auto collect = [](hid_t, const char* name, const H5A_info_t*, void* list) -> herr_t {
    static_cast<std::vector<std::string>*>(list)->emplace_back(name);
    return 0;
  };
  check(H5Aiterate2(object, H5_INDEX_NAME, H5_ITER_INC, nullptr, collect, &names), "listing attributes");
  return names;
}

constexpr const char* signals_attribute = "flinch.signals";
constexpr const char* period_attribute = "flinch.period_ns";

void write_to(const Recording& recording, const std::filesystem::path& file) {
  const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose, "making file properties");
  check(H5Pset_libver_bounds(access, H5F_LIBVER_V18, H5F_LIBVER_LATEST), "choosing the file version");
  const Handle hdf(H5Fcreate(file.c_str(), H5F_ACC_TRUNC, timeless(H5P_FILE_CREATE), access), H5Fclose,
                   "creating the file");
  const Handle root(H5Gopen2(hdf, "/", H5P_DEFAULT), H5Gclose, "opening the root group");
  std::vector<Number> times(recording.samples());
  for (std::size_t k = 0; k < times.size(); ++k) times[k].integer = recording.time_ns[k];
  write_numbers(root, "time_ns", Field::Kind::integer, times, times.size());
  std::string paths;
  for (const Signal& signal : recording.signals) {
    write_signal(root, signal, recording.samples(), recording.period);
    paths += (paths.empty() ? "" : "\n") + signal.path;
  }
  write_text(root, signals_attribute, paths);
  write_integer(root, period_attribute, recording.period.count());
  for (const auto& [name, text] : recording.attributes) write_text(root, name, text);
}

Recording read_from(const std::filesystem::path& file) {
  const Handle hdf(H5Fopen(file.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose,
                   "opening the file: it is no HDF5 file, or its end is missing");
  const Handle root(H5Gopen2(hdf, "/", H5P_DEFAULT), H5Gclose, "opening the root group");
  Recording recording;
  recording.period = Time(read_integer(root, period_attribute));
  const Handle set(H5Dopen2(root, "time_ns", H5P_DEFAULT), H5Dclose, "opening the data set 'time_ns'");
  const Handle space(H5Dget_space(set), H5Sclose, "reading the number of samples");
  hsize_t size[2] = {0, 0};
  if (H5Sget_simple_extent_dims(space, size, nullptr) != 2) throw SetupError("'time_ns' is no column");
  for (const Number& time : read_numbers(root, "time_ns", Field::Kind::integer, size[0], 1)) {
    recording.time_ns.push_back(time.integer);
  }
  for (const std::string& path : lines_of(read_text(root, signals_attribute))) {
    recording.signals.push_back(read_signal(root, path, recording.samples()));
  }
  for (const std::string& name : attribute_names(root)) {
    if (name != signals_attribute && name != period_attribute)
      recording.attributes[name] = read_text(root, name);
  }
  return recording;
}

}  // namespace

void write_recording(const Recording& recording, const std::filesystem::path& file) {
  silence_hdf5();
  const std::filesystem::path unfinished = file.string() + ".part";
  std::error_code error;
  try {
    write_to(recording, unfinished);
  } catch (const SetupError& failure) {
    std::filesystem::remove(unfinished, error);
    throw SetupError(file.string() + ": the recording cannot be written: " + failure.what());
  }
  std::filesystem::rename(unfinished, file, error);
  if (error) throw SetupError(file.string() + ": the recording cannot be written: " + error.message());
}

Recording read_recording(const std::filesystem::path& file) {
  silence_hdf5();
  std::error_code error;
  if (!std::filesystem::exists(file, error)) throw SetupError(file.string() + ": there is no such file");
  try {
    return read_from(file);
  } catch (const SetupError& failure) {
    throw SetupError(file.string() + ": this is no whole flinch recording: " + failure.what());
  }
}

}  // namespace flinch
