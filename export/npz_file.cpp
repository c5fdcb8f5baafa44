#include "export/npz_file.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <string>

#include "export/byte_text.h"
#include "export/deflated_bytes.h"
#include "systems/foundation/result_file.h"
#include "systems/foundation/setup_error.h"

namespace flinch {
namespace {

using internal::Number;

constexpr std::size_t most_bytes = std::numeric_limits<std::uint32_t>::max();

/// A zip file while it is written. PKWARE, APPNOTE.TXT 4.3
class ZipFile {
 public:
  explicit ZipFile(const std::filesystem::path& file) : name_(file), file_(file) {}

  void add(const std::string& name, DeflatedBytes& content) {
    const std::string& bytes = content.finish();
    const std::string description = described(content, bytes.size(), name);
    directory_ += signature(0x02014b50) + short_number(20) + description;
    for (int i = 0; i < 3; ++i) directory_ += short_number(0);  // comment, disk, kind
    append_bytes(std::uint32_t{0}, directory_);                 // rights
    append_bytes(static_cast<std::uint32_t>(size_), directory_);
    directory_ += name;
    ++entries_;
    write(signature(0x04034b50) + description + name);
    write(bytes);
  }

  void finish() {
    const std::size_t begin = size_;
    std::string end = signature(0x06054b50) + short_number(0) + short_number(0) + short_number(entries_) +
                      short_number(entries_);
    append_bytes(static_cast<std::uint32_t>(directory_.size()), end);
    append_bytes(static_cast<std::uint32_t>(begin), end);
    write(directory_);
    write(end + short_number(0));
    file_.finish();
  }

 private:
  static std::string signature(std::uint32_t number) {
    std::string bytes;
    append_bytes(number, bytes);
    return bytes;
  }
  static std::string short_number(std::size_t number) {
    std::string bytes;
    append_bytes(static_cast<std::uint16_t>(number), bytes);
    return bytes;
  }

  /// What stands of an entry in both places: deflated, of 1 January 1980, so that equal recordings give equal
  /// files.
  std::string described(const DeflatedBytes& content, std::size_t compressed, const std::string& name) const {
    if (content.size_before() > most_bytes) throw too_large();
    std::string bytes =
        short_number(20) + short_number(0) + short_number(8) + short_number(0) + short_number(33);
    append_bytes(content.checksum(), bytes);
    append_bytes(static_cast<std::uint32_t>(compressed), bytes);
    append_bytes(static_cast<std::uint32_t>(content.size_before()), bytes);
    return bytes + short_number(name.size()) + short_number(0);
  }

  void write(const std::string& bytes) {
    size_ += bytes.size();
    if (size_ > most_bytes || entries_ > 65'000) throw too_large();
    file_.write(bytes);
  }

  SetupError too_large() const {
    return SetupError(name_.string() + ": would be larger than 4 GB; choose signals with --signal");
  }

  std::filesystem::path name_;
  ResultFile file_;
  std::string directory_;
  std::size_t size_ = 0;
  std::size_t entries_ = 0;
};

/// The head of an array. NumPy, NEP 1
std::string npy_head(const std::string& type, std::size_t samples, std::size_t width) {
  std::string text = "{'descr': '" + type + "', 'fortran_order': False, 'shape': (" +
                     std::to_string(samples) + ", " + (width > 0 ? std::to_string(width) : "") + "), }";
  constexpr std::size_t before = 10, multiple = 64;
  text.append(multiple - (before + text.size() + 1) % multiple, ' ');
  text += '\n';
  std::string head("\x93NUMPY\x01\x00", 8);
  append_bytes(static_cast<std::uint16_t>(text.size()), head);
  return head + text;
}

/// An array while its rows come.
class NpyArray {
 public:
  NpyArray(const ExportedField& field, std::size_t samples) : field_(&field) {
    const bool is_one = field.components.front().empty();
    add(npy_head(type_of(field.kind), samples, is_one ? 0 : field.width()));
  }

  void add(std::size_t count, const Number* rows, std::size_t stride) {
    std::string bytes;
    for (std::size_t k = 0; k < count; ++k) append_row(rows + k * stride, bytes);
    add(bytes);
  }
  DeflatedBytes& bytes() { return bytes_; }

 private:
  static std::string type_of(Field::Kind kind) {
    if (kind == Field::Kind::boolean) return "|b1";
    return kind == Field::Kind::integer ? "<i8" : "<f8";
  }
  void add(const std::string& bytes) { bytes_.add(bytes.data(), bytes.size()); }

  void append_row(const Number* row, std::string& bytes) const {
    const std::size_t there = field_->numbers_in(row);
    for (std::size_t i = 0; i < field_->width(); ++i) {
      const Number& number = row[field_->first + i];
      if (field_->kind == Field::Kind::boolean)
        bytes += number.integer != 0 ? '\1' : '\0';
      else if (field_->kind == Field::Kind::integer)
        append_bytes(number.integer, bytes);
      else
        append_bytes(i < there ? number.real : std::numeric_limits<double>::quiet_NaN(), bytes);
    }
  }

  const ExportedField* field_;
  DeflatedBytes bytes_{DeflatedBytes::Form::raw};
};

void add_signal(const Recording& recording, const ExportedSignal& signal, ZipFile& zip) {
  std::vector<NpyArray> arrays;
  for (const ExportedField& field : signal.fields) arrays.emplace_back(field, recording.samples());
  const std::size_t stride = signal.signal->layout.numbers;
  for_each_block(recording, *signal.signal, [&](std::size_t, std::size_t count, const Number* rows) {
    for (NpyArray& array : arrays) array.add(count, rows, stride);
  });
  std::string name = signal.path;
  std::replace(name.begin(), name.end(), '/', '.');
  for (std::size_t i = 0; i < arrays.size(); ++i)
    zip.add(name + "." + signal.fields[i].name + ".npy", arrays[i].bytes());
}

}  // namespace

void write_npz(const Recording& recording, const std::vector<ExportedSignal>& signals,
               const std::filesystem::path& file) {
  ZipFile zip(file);
  DeflatedBytes time(DeflatedBytes::Form::raw), description(DeflatedBytes::Form::raw);
  std::string bytes = npy_head("<f8", recording.samples(), 0);
  for (const std::int64_t time_ns : recording.time_ns)
    append_bytes(static_cast<double>(time_ns) / 1e9, bytes);
  time.add(bytes.data(), bytes.size());
  zip.add("time_s.npy", time);
  for (const ExportedSignal& signal : signals) add_signal(recording, signal, zip);
  const std::string text = description_json(recording, signals) + "\n";
  description.add(text.data(), text.size());
  zip.add("signals.json", description);
  zip.finish();
}

}  // namespace flinch
