#include "export/mat_file.h"

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <limits>
#include <set>
#include <string>

#include "export/byte_text.h"
#include "export/deflated_bytes.h"
#include "systems/foundation/result_file.h"
#include "systems/foundation/setup_error.h"

namespace flinch {
namespace {

using internal::Number;

constexpr std::size_t most_bytes_of_variable = std::numeric_limits<std::int32_t>::max();
constexpr std::size_t longest_name = 63;

// Types of data elements and classes of arrays. MATLAB, MAT-File Format, Tables 1-1 and 1-3
enum Element : std::uint32_t {
  int8 = 1,
  uint8 = 2,
  uint16 = 4,
  int32 = 5,
  uint32 = 6,
  real = 9,
  int64 = 12,
  matrix = 14,
  compressed = 15
};
enum Class : std::uint32_t { structure = 2, text = 4, reals = 6, logicals = 9, integers = 14 };
constexpr std::uint32_t is_logical = 0x200;

void append_element(Element type, const std::string& data, std::string& bytes) {
  append_bytes(static_cast<std::uint32_t>(type), bytes);
  append_bytes(static_cast<std::uint32_t>(data.size()), bytes);
  bytes += data;
  bytes.append((8 - data.size() % 8) % 8, '\0');
}

/// Flags, dimensions and name, with which every array begins.
std::string head_of(std::uint32_t kind, std::size_t rows, std::size_t columns, const std::string& name) {
  std::string flags, dimensions, head;
  append_bytes(kind, flags);
  append_bytes(std::uint32_t{0}, flags);
  append_bytes(static_cast<std::int32_t>(rows), dimensions);
  append_bytes(static_cast<std::int32_t>(columns), dimensions);
  append_element(uint32, flags, head);
  append_element(int32, dimensions, head);
  append_element(int8, name, head);
  return head;
}

std::string text_array(const std::string& value) {
  std::string characters, content = head_of(Class::text, 1, value.size(), ""), bytes;
  for (const char c : value)
    append_bytes(static_cast<std::uint16_t>(static_cast<unsigned char>(c)), characters);
  append_element(uint16, characters, content);
  append_element(matrix, content, bytes);
  return bytes;
}

/// A name that MATLAB takes, and that is not among `taken`.
std::string matlab_name(std::string name, std::set<std::string>& taken) {
  for (char& c : name) {
    if (std::isalnum(static_cast<unsigned char>(c)) == 0) c = '_';
  }
  if (name.empty() || std::isalpha(static_cast<unsigned char>(name.front())) == 0) name.insert(0, "x");
  name.resize(std::min(name.size(), longest_name));
  for (int i = 2; !taken.insert(name).second; ++i) {
    const std::string end = "_" + std::to_string(i);
    name = name.substr(0, longest_name - end.size()) + end;
  }
  return name;
}

std::vector<std::string> matlab_names(const std::vector<std::string>& names) {
  std::set<std::string> taken;
  std::vector<std::string> result;
  for (const std::string& name : names) result.push_back(matlab_name(name, taken));
  return result;
}

/// What stands before the fields of a struct.
std::string struct_head(const std::string& name, const std::vector<std::string>& fields) {
  std::string head = head_of(Class::structure, 1, 1, name);
  append_bytes(static_cast<std::uint16_t>(int32), head);  // a small element
  append_bytes(std::uint16_t{4}, head);
  append_bytes(static_cast<std::int32_t>(longest_name + 1), head);
  std::string names;
  for (const std::string& field : fields) names += field + std::string(longest_name + 1 - field.size(), '\0');
  append_element(int8, names, head);
  return head;
}

/// A struct as an element, of elements that are whole.
std::string struct_element(const std::string& name, const std::vector<std::string>& fields,
                           const std::vector<std::string>& values) {
  std::string content = struct_head(name, fields), bytes;
  for (const std::string& value : values) content += value;
  append_element(matrix, content, bytes);
  return bytes;
}

/// A file while its variables come.
class MatFile {
 public:
  explicit MatFile(const std::filesystem::path& file) : name_(file), file_(file) {
    std::string head = "MATLAB 5.0 MAT-file, written by flinch " FLINCH_VERSION;
    head.resize(124, ' ');
    append_bytes(std::uint16_t{0x0100}, head);
    file_.write(head + "IM");
  }

  /// `element` begins with its type and size; `size` bytes are compressed already.
  void add(DeflatedBytes& element) {
    const std::string& bytes = element.finish();
    if (element.size_before() > most_bytes_of_variable) throw too_large();
    std::string head;
    append_bytes(static_cast<std::uint32_t>(compressed), head);
    append_bytes(static_cast<std::uint32_t>(bytes.size()), head);
    file_.write(head);
    file_.write(bytes);
  }
  void add(const std::string& element) {
    DeflatedBytes bytes(DeflatedBytes::Form::zlib);
    bytes.add(element.data(), element.size());
    add(bytes);
  }
  void finish() { file_.finish(); }

  SetupError too_large() const {
    return SetupError(
        name_.string() +
        ": a signal takes more than the 2 GB that a file of MATLAB 5 allows; choose others with "
        "--signal, or --to npz");
  }

 private:
  std::filesystem::path name_;
  ResultFile file_;
};

// ---------------------------------------------------------------- arrays of a signal

Element type_of(Field::Kind kind) {
  if (kind == Field::Kind::boolean) return uint8;
  return kind == Field::Kind::integer ? int64 : real;
}
std::uint32_t class_of(Field::Kind kind) {
  if (kind == Field::Kind::boolean) return logicals | is_logical;
  return kind == Field::Kind::integer ? integers : reals;
}
std::size_t bytes_of_number(Field::Kind kind) { return kind == Field::Kind::boolean ? 1 : 8; }

/// An array of a field, filled row by row; MATLAB has it column by column.
class MatArray {
 public:
  MatArray(const ExportedField& field, std::size_t samples)
      : field_(&field),
        samples_(samples),
        size_(bytes_of_number(field.kind)),
        data_(samples * field.width() * size_, '\0') {}

  void set(std::size_t sample, const Number* row) {
    const std::size_t there = field_->numbers_in(row);
    for (std::size_t i = 0; i < field_->width(); ++i) {
      char* const place = data_.data() + (i * samples_ + sample) * size_;
      Number number = row[field_->first + i];
      if (i >= there) number.real = std::numeric_limits<double>::quiet_NaN();
      if (size_ == 1)
        *place = number.integer != 0 ? '\1' : '\0';
      else
        std::memcpy(place, &number, size_);
    }
  }

  /// The element's bytes before its data and after them.
  std::string head() const {
    const std::string content = head_of(class_of(field_->kind), samples_, field_->width(), "");
    std::string bytes;
    append_bytes(static_cast<std::uint32_t>(matrix), bytes);
    append_bytes(static_cast<std::uint32_t>(content.size() + 8 + data_.size() + padding()), bytes);
    bytes += content;
    append_bytes(static_cast<std::uint32_t>(type_of(field_->kind)), bytes);
    append_bytes(static_cast<std::uint32_t>(data_.size()), bytes);
    return bytes;
  }
  const std::string& data() const { return data_; }
  std::size_t padding() const { return (8 - data_.size() % 8) % 8; }
  std::size_t size() const { return head().size() + data_.size() + padding(); }

 private:
  const ExportedField* field_;
  std::size_t samples_;
  std::size_t size_;
  std::string data_;
};

void add_signal(const Recording& recording, const ExportedSignal& signal, const std::string& name,
                MatFile& file) {
  std::size_t bytes_of_all = 0;
  for (const ExportedField& field : signal.fields)
    bytes_of_all += recording.samples() * field.width() * bytes_of_number(field.kind);
  if (bytes_of_all > most_bytes_of_variable) throw file.too_large();
  std::vector<MatArray> arrays;
  std::vector<std::string> names;
  for (const ExportedField& field : signal.fields) {
    arrays.emplace_back(field, recording.samples());
    names.push_back(field.name);
  }
  const std::size_t stride = signal.signal->layout.numbers;
  for_each_block(recording, *signal.signal, [&](std::size_t first, std::size_t count, const Number* rows) {
    for (std::size_t k = 0; k < count; ++k) {
      for (MatArray& array : arrays) array.set(first + k, rows + k * stride);
    }
  });
  const std::string head = struct_head(name, matlab_names(names));
  std::size_t size = head.size();
  for (const MatArray& array : arrays) size += array.size();
  if (size > most_bytes_of_variable) throw file.too_large();
  std::string begin;
  append_bytes(static_cast<std::uint32_t>(matrix), begin);
  append_bytes(static_cast<std::uint32_t>(size), begin);
  DeflatedBytes element(DeflatedBytes::Form::zlib);
  const auto add = [&element](const std::string& bytes) { element.add(bytes.data(), bytes.size()); };
  add(begin + head);
  for (const MatArray& array : arrays) {
    add(array.head());
    add(array.data());
    add(std::string(array.padding(), '\0'));
  }
  file.add(element);
}

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (&word == &words.front() ? "" : ", ") + word;
  return text;
}

/// The struct called `variable` with a text for each field of each signal.
template <class TextOf>
std::string texts(const std::string& variable, const std::vector<ExportedSignal>& signals,
                  const std::vector<std::string>& names, const TextOf& text_of) {
  std::vector<std::string> of_signals;
  for (const ExportedSignal& signal : signals) {
    std::vector<std::string> fields, values;
    for (const ExportedField& field : signal.fields) {
      fields.push_back(field.name);
      values.push_back(text_array(text_of(field)));
    }
    of_signals.push_back(struct_element("", matlab_names(fields), values));
  }
  return struct_element(variable, names, of_signals);
}

std::string time_variable(const Recording& recording) {
  std::string data, content = head_of(reals, recording.samples(), 1, "time_s"), bytes;
  for (const std::int64_t time_ns : recording.time_ns) append_bytes(static_cast<double>(time_ns) / 1e9, data);
  append_element(real, data, content);
  append_element(matrix, content, bytes);
  return bytes;
}

}  // namespace

void write_mat(const Recording& recording, const std::vector<ExportedSignal>& signals,
               const std::filesystem::path& file) {
  MatFile mat(file);
  std::set<std::string> taken = {"time_s", "units", "components", "frames"};
  std::vector<std::string> names;
  for (const ExportedSignal& signal : signals) names.push_back(matlab_name(signal.path, taken));
  mat.add(time_variable(recording));
  for (std::size_t i = 0; i < signals.size(); ++i) add_signal(recording, signals[i], names[i], mat);
  mat.add(texts("units", signals, names, [](const ExportedField& field) { return joined(field.units); }));
  mat.add(texts("components", signals, names,
                [](const ExportedField& field) { return joined(field.components); }));
  mat.add(texts("frames", signals, names, [](const ExportedField& field) { return field.frame; }));
  mat.finish();
}

}  // namespace flinch
