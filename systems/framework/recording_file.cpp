#include "systems/framework/recording_file.h"

#include <algorithm>
#include <set>
#include <system_error>

#include "systems/foundation/setup_error.h"
#include "systems/framework/hdf5_format.h"
#include "systems/framework/hdf5_table.h"
#include "systems/framework/recording_check.h"
#include "systems/framework/recording_journal.h"

namespace flinch {
namespace {

using internal::Hdf5Object;
using internal::Number;

constexpr const char* signals_attribute = "flinch.signals";
constexpr const char* period_attribute = "flinch.period_ns";
constexpr const char* time_table = "time_ns";

constexpr std::size_t most_tables = 20'000;
constexpr std::size_t most_samples = 1 << 24;  ///< of the smallest file; larger ones may have more

std::string joined(const std::string& lines, const std::string& line) {
  return lines.empty() ? line : lines + "\n" + line;
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

/// One dataset of a signal: columns first ... first + columns of its rows.
struct Column {
  std::string name;
  Field::Kind kind;
  std::size_t first;
  std::size_t columns;
};

std::vector<Column> columns_of(const RowLayout& layout) {
  std::vector<Column> columns;
  std::size_t first = 0;
  for (const Field& field : layout.fields) {
    if (field.resizable) {
      columns.push_back({field.name + ".size", Field::Kind::integer, first, 2});
      first += 2;
    }
    const auto capacity = static_cast<std::size_t>(field.capacity);
    columns.push_back({field.name, field.kind, first, capacity});
    first += capacity;
  }
  return columns;
}

/// One signal of an HDF5 file.
struct Table {
  std::size_t numbers;  ///< of a row of the signal
  std::vector<Column> columns;
  std::vector<internal::Table> sets;  ///< one for each column
};

Table make_tables(Hdf5Object::Id root, const Signal& signal, Time period, std::size_t chunk_rows) {
  const Hdf5Object group = internal::make_group(root, signal.path);
  internal::write_integer(group, "period_ns", period.count());
  Table table{signal.layout.numbers, columns_of(signal.layout), {}};
  std::string order;
  auto field = signal.layout.fields.begin();
  for (const Column& column : table.columns) {
    table.sets.push_back({internal::make_table(group, column.name, column.kind, column.columns, chunk_rows)});
    if (column.name != field->name) continue;  // the sizes before a field
    const Hdf5Object& set = table.sets.back().set;
    internal::write_text(set, "unit", field->unit);
    internal::write_text(set, "frame", field->frame);
    internal::write_integer(set, "kind", static_cast<std::int64_t>(field->kind));
    internal::write_integer(set, "capacity", field->capacity);
    internal::write_integer(set, "resizable", field->resizable ? 1 : 0);
    order = joined(order, field->name);
    ++field;
  }
  internal::write_text(group, "fields", order);
  return table;
}

Field read_field(Hdf5Object::Id group, const std::string& name) {
  const Hdf5Object set = internal::open_data_set(group, name);
  return internal::checked_field(name, internal::read_text(set, "unit"), internal::read_text(set, "frame"),
                                 internal::read_integer(set, "kind"), internal::read_integer(set, "capacity"),
                                 internal::read_integer(set, "resizable"));
}

Table open_tables(Hdf5Object::Id root, std::size_t samples, Signal& signal) {
  const Hdf5Object group = internal::open_group(root, signal.path);
  for (const std::string& name : lines_of(internal::read_text(group, "fields"))) {
    internal::add_field(read_field(group, name), signal.layout);
  }
  Table table{signal.layout.numbers, columns_of(signal.layout), {}};
  for (const Column& column : table.columns) {
    internal::Table opened = internal::open_table(group, column.name, column.kind, column.columns);
    if (opened.rows != samples) {
      throw SetupError("the data set '" + column.name + "' of '" + signal.path + "' has " +
                       std::to_string(opened.rows) + " samples instead of " + std::to_string(samples));
    }
    table.sets.push_back(std::move(opened));
  }
  return table;
}

/// The rows of an HDF5 file.
class RecordingFile final : public RowSource {
 public:
  /// Opens `file` and says in `recording` what is in it.
  RecordingFile(const std::filesystem::path& file, Recording& recording) {
    const std::lock_guard lock(internal::hdf5_mutex());
    Hdf5Object hdf = internal::open_hdf5_file(file);
    Hdf5Object root = internal::open_group(hdf, "/");
    recording.period = internal::checked_period(internal::read_integer(root, period_attribute));
    recording.time_ns = read_times(root);
    Open open{std::move(hdf), std::move(root), {}};
    // Many names of one data set would cost memory that the file does not have.
    std::set<std::uint64_t> opened;
    for (const std::string& path : lines_of(internal::read_text(open.root, signals_attribute))) {
      Signal signal{path, {}, {}};
      Table tables = open_tables(open.root, recording.samples(), signal);
      for (const internal::Table& table : tables.sets) {
        if (!opened.insert(internal::address(table.set)).second || opened.size() > most_tables) {
          throw SetupError("the signal '" + path + "' has a data set of another, or is one of too many");
        }
      }
      open.tables.emplace(path, std::move(tables));
      recording.signals.push_back(std::move(signal));
    }
    for (const std::string& name : internal::attribute_names(open.root)) {
      if (name == signals_attribute || name == period_attribute) continue;
      recording.attributes[name] = internal::read_text(open.root, name);
    }
    open_ = std::make_unique<Open>(std::move(open));
  }
  ~RecordingFile() override {
    const std::lock_guard lock(internal::hdf5_mutex());
    open_.reset();
  }
  RecordingFile(const RecordingFile&) = delete;
  RecordingFile& operator=(const RecordingFile&) = delete;

  void read(const std::string& path, std::size_t first, std::size_t count, Number* rows) const override {
    Table& table = open_->tables.at(path);
    const std::vector<internal::TakenRows> taken = taken_from(table, first, count);
    std::vector<Number> numbers;
    for (std::size_t i = 0; i < table.columns.size(); ++i) {
      const Column& column = table.columns[i];
      numbers.resize(count * column.columns);
      taken[i].unpack(numbers.data());
      for (std::size_t k = 0; k < count; ++k) {
        std::copy_n(numbers.data() + k * column.columns, column.columns,
                    rows + k * table.numbers + column.first);
      }
    }
  }

 private:
  struct Open {
    Hdf5Object hdf;
    Hdf5Object root;
    std::map<std::string, Table> tables;
  };

  /// Of each column.
  static std::vector<internal::TakenRows> taken_from(Table& table, std::size_t first, std::size_t count) {
    const std::lock_guard lock(internal::hdf5_mutex());
    std::vector<internal::TakenRows> taken;
    for (std::size_t i = 0; i < table.columns.size(); ++i) {
      const Column& column = table.columns[i];
      taken.push_back(internal::take_rows(table.sets[i], column.kind, first, count, column.columns));
    }
    return taken;
  }

  static std::vector<std::int64_t> read_times(Hdf5Object::Id root) {
    internal::Table table = internal::open_table(root, time_table, Field::Kind::integer, 1);
    if (table.rows > most_samples + internal::file_size(root) / 2) {
      throw SetupError("there are " + std::to_string(table.rows) + " samples in so small a file");
    }
    std::vector<std::int64_t> times(table.rows);
    std::vector<Number> numbers(std::min(table.rows, Recording::block));
    for (std::size_t first = 0; first < table.rows; first += numbers.size()) {
      const std::size_t count = std::min(numbers.size(), table.rows - first);
      internal::read_rows(table, Field::Kind::integer, first, count, 1, numbers.data());
      for (std::size_t k = 0; k < count; ++k) times[first + k] = numbers[k].integer;
    }
    internal::check_times(times);
    return times;
  }

  std::unique_ptr<Open> open_;
};

/// What a block of samples, or the attributes, take at most in the file.
std::size_t most_bytes_of(const Recording& block) {
  constexpr std::size_t index = 1 << 14;  // of the chunks of one data set, and its description
  std::size_t bytes = std::size_t{1} << 20;
  for (const Signal& signal : block.signals) {
    bytes += signal.rows.size() * sizeof(Number) + (2 * signal.layout.fields.size() + 1) * index;
  }
  return bytes + block.time_ns.size() * sizeof(Number);
}

std::size_t most_bytes_of(const std::map<std::string, std::string>& attributes) {
  std::size_t bytes = std::size_t{1} << 20;
  for (const auto& [name, text] : attributes) bytes += name.size() + text.size() + 1024;
  return bytes;
}

}  // namespace

/// The HDF5 side of a RecordingFileWriter. Its datasets are made when the first samples are written, for only
/// then is it known whether they fill a chunk.
class RecordingFileWriter::Tables {
 public:
  explicit Tables(const std::filesystem::path& file)
      : hdf_(internal::create_hdf5_file(file)), root_(internal::open_group(hdf_, "/")) {}

  void append(const Recording& block) {
    if (signals_.empty()) make(block);
    std::vector<Number> numbers(block.samples());
    for (std::size_t k = 0; k < numbers.size(); ++k) numbers[k].integer = block.time_ns[k];
    internal::append_rows(times_.front(), Field::Kind::integer, written_, numbers.size(), 1, numbers.data());
    for (std::size_t s = 0; s < signals_.size(); ++s) append(signals_[s], block.signals[s], block.samples());
    written_ += block.samples();
  }

  /// Writes the attributes, and whatever HDF5 still keeps.
  void finish(const Recording& description, const std::map<std::string, std::string>& attributes) {
    std::string paths;
    for (const Signal& signal : description.signals) paths = joined(paths, signal.path);
    internal::write_text(root_, signals_attribute, paths);
    internal::write_integer(root_, period_attribute, description.period.count());
    for (const auto& [name, text] : attributes) internal::write_text(root_, name, text);
    signals_.clear();
    times_.clear();
    root_.close_now();
    internal::close_hdf5_file(std::move(hdf_));
  }

  void abandon() const noexcept { internal::abandon_hdf5_file(hdf_); }

 private:
  void make(const Recording& block) {
    const std::size_t chunk = std::clamp<std::size_t>(block.samples(), 1, Recording::block);
    times_.push_back(internal::make_table(root_, time_table, Field::Kind::integer, 1, chunk));
    for (const Signal& signal : block.signals) {
      signals_.push_back(make_tables(root_, signal, block.period, chunk));
    }
  }

  void append(const Table& table, const Signal& signal, std::size_t samples) const {
    std::vector<Number> numbers;
    for (std::size_t i = 0; i < table.columns.size(); ++i) {
      const Column& column = table.columns[i];
      numbers.resize(samples * column.columns);
      for (std::size_t k = 0; k < samples; ++k) {
        std::copy_n(signal.rows.data() + k * table.numbers + column.first, column.columns,
                    numbers.data() + k * column.columns);
      }
      internal::append_rows(table.sets[i].set, column.kind, written_, samples, column.columns,
                            numbers.data());
    }
  }

  Hdf5Object hdf_;
  Hdf5Object root_;
  std::vector<Hdf5Object> times_;  ///< none yet, or one
  std::vector<Table> signals_;
  std::size_t written_ = 0;
};

RecordingFileWriter::RecordingFileWriter(const Recording& description, const std::filesystem::path& file)
    : file_(file), result_(file), block_{description.period, {}, {}, {}, nullptr} {
  for (const Signal& signal : description.signals) block_.signals.push_back({signal.path, signal.layout, {}});
  const std::lock_guard lock(internal::hdf5_mutex());
  telling_file([&] { tables_ = std::make_unique<Tables>(result_.unfinished_name()); });
}

RecordingFileWriter::~RecordingFileWriter() {
  const std::lock_guard lock(internal::hdf5_mutex());
  if (tables_ != nullptr) tables_->abandon();
  tables_.reset();
}

void RecordingFileWriter::append(const SampleBlock& samples) {
  for (std::size_t first = 0; first < samples.samples();) {
    const std::size_t count = std::min(samples.samples() - first, Recording::block - block_.samples());
    block_.append(samples.part(first, count));
    if (block_.samples() == Recording::block) write_block();
    first += count;
  }
}

void RecordingFileWriter::write_block() {
  const std::lock_guard lock(internal::hdf5_mutex());
  telling_file([&] {
    result_.reserve(most_bytes_of(block_));
    tables_->append(block_);
  });
  block_.time_ns.clear();
  for (Signal& signal : block_.signals) signal.rows.clear();
  is_empty_ = false;
}

void RecordingFileWriter::finish(const std::map<std::string, std::string>& attributes) {
  if (is_empty_ || block_.samples() > 0) write_block();
  telling_file([&] {
    const std::lock_guard lock(internal::hdf5_mutex());
    result_.reserve(most_bytes_of(attributes));
    tables_->finish(block_, attributes);
    tables_.reset();
  });
  result_.finish();
}

template <class Work>
void RecordingFileWriter::telling_file(const Work& work) const {
  try {
    work();
  } catch (const SetupError& failure) {
    throw SetupError(file_.string() + ": the recording cannot be written: " + failure.what());
  }
}

void write_recording(const Recording& recording, const std::filesystem::path& file) {
  RecordingFileWriter writer(recording, file);
  std::vector<std::vector<Number>> rows(recording.signals.size());
  for (std::size_t first = 0; first < recording.samples(); first += Recording::block) {
    const std::size_t count = std::min(Recording::block, recording.samples() - first);
    SampleBlock block{std::span(recording.time_ns).subspan(first, count), {}};
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const Signal& signal = recording.signals[i];
      rows[i].resize(count * signal.layout.numbers);
      recording.read_rows(signal, first, count, rows[i].data());
      block.rows.push_back({rows[i].data(), signal.layout.numbers, signal.layout.numbers});
    }
    writer.append(block);
  }
  writer.finish(recording.attributes);
}

void read_every_row(const Recording& recording) {
  std::vector<Number> rows;
  for (const Signal& signal : recording.signals) {
    for (std::size_t first = 0; first < recording.samples(); first += Recording::block) {
      const std::size_t count = std::min(Recording::block, recording.samples() - first);
      rows.resize(count * signal.layout.numbers);
      recording.read_rows(signal, first, count, rows.data());
    }
  }
}

Recording open_recording(const std::filesystem::path& file) {
  std::error_code error;
  const std::filesystem::path part = part_name(file);
  if (!std::filesystem::exists(file, error)) {
    if (std::filesystem::exists(part, error)) return open_journal(part);
    throw SetupError(file.string() + ": there is no such file");
  }
  if (is_journal(file)) return open_journal(file);
  try {
    Recording recording;
    recording.source = std::make_shared<RecordingFile>(file, recording);
    return recording;
  } catch (const SetupError& failure) {
    if (const std::string format = hdf5_format(file); !format.empty()) {
      const std::string why = format.starts_with("flinch ") ? "" : std::string(": ") + failure.what();
      throw SetupError(file.string() + ": is no recording; it says that it is '" + format + "'" + why);
    }
    throw SetupError(file.string() + ": this is no whole flinch recording: " + failure.what());
  }
}

Recording read_recording(const std::filesystem::path& file) {
  Recording recording = open_recording(file);
  try {
    for (Signal& signal : recording.signals) {
      std::vector<Number> rows(recording.samples() * signal.layout.numbers);
      recording.read_rows(signal, 0, recording.samples(), rows.data());
      signal.rows = std::move(rows);
    }
  } catch (const SetupError& failure) {
    throw SetupError(file.string() + ": this is no whole flinch recording: " + failure.what());
  }
  recording.source = nullptr;
  return recording;
}

}  // namespace flinch
