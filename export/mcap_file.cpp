#include "export/mcap_file.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>

#include "export/byte_text.h"
#include "systems/foundation/json_text.h"
#include "systems/foundation/result_file.h"

namespace flinch {
namespace {

using internal::Number;
using McapJson = nlohmann::ordered_json;

constexpr std::size_t samples_of_chunk = 256;
static_assert(Recording::block % samples_of_chunk == 0);

// mcap.dev, MCAP Format Specification, Records
enum Record : unsigned char {
  header = 0x01,
  footer = 0x02,
  schema = 0x03,
  channel = 0x04,
  message = 0x05,
  chunk = 0x06,
  message_index = 0x07,
  chunk_index = 0x08,
  statistics = 0x0B,
  data_end = 0x0F
};
const std::string magic("\x89MCAP0\r\n", 8);

void append_text(const std::string& text, std::string& bytes) {
  append_bytes(static_cast<std::uint32_t>(text.size()), bytes);
  bytes += text;
}

std::string record(Record kind, const std::string& content) {
  std::string bytes(1, static_cast<char>(kind));
  append_bytes(static_cast<std::uint64_t>(content.size()), bytes);
  return bytes + content;
}

// ---------------------------------------------------------------- messages

bool is_numbered(const ExportedField& field) {
  return std::isdigit(static_cast<unsigned char>(field.components.front()[0])) != 0;
}

McapJson number_schema(const ExportedField& field, std::size_t i) {
  McapJson schema = {{"type", field.kind == Field::Kind::boolean ? "boolean" : "number"}};
  if (!field.units[i].empty()) schema["description"] = field.units[i];
  return schema;
}

McapJson field_schema(const ExportedField& field) {
  if (field.components.front().empty()) return number_schema(field, 0);
  if (is_numbered(field)) return {{"type", "array"}, {"items", number_schema(field, 0)}};
  McapJson parts = McapJson::object();
  for (std::size_t i = 0; i < field.width(); ++i) parts[field.components[i]] = number_schema(field, i);
  McapJson schema = {{"type", "object"}, {"properties", parts}};
  if (!field.frame.empty()) schema["description"] = "in frame " + field.frame;
  return schema;
}

std::string schema_of(const ExportedSignal& signal) {
  McapJson fields = McapJson::object();
  for (const ExportedField& field : signal.fields) fields[field.name] = field_schema(field);
  return json_text(McapJson{{"type", "object"}, {"properties", fields}});
}

template <class Value>
void append_value(Value value, std::string& text) {
  char digits[32];
  text.append(digits, std::to_chars(digits, digits + sizeof digits, value).ptr);
}

void append_number(const ExportedField& field, const Number& number, std::string& text) {
  if (field.kind == Field::Kind::boolean)
    text += number.integer != 0 ? "true" : "false";
  else if (field.kind == Field::Kind::integer)
    append_value(number.integer, text);
  else if (std::isfinite(number.real))
    append_value(number.real, text);
  else
    text += "null";
}

/// The messages of one signal, whose names are made to JSON once.
class Messages {
 public:
  explicit Messages(const ExportedSignal& signal) : signal_(&signal) {
    for (const ExportedField& field : signal.fields) {
      Names names{json_text(McapJson(field.name)) + ":", {}};
      const bool is_named = !field.components.front().empty() && !is_numbered(field);
      for (const std::string& part : field.components)
        names.parts.push_back(is_named ? json_text(McapJson(part)) + ":" : "");
      names_.push_back(std::move(names));
    }
  }

  void append(const Number* row, std::string& text) const {
    text += '{';
    for (std::size_t i = 0; i < names_.size(); ++i) {
      if (i > 0) text += ',';
      text += names_[i].field;
      append_field(signal_->fields[i], names_[i].parts, row, text);
    }
    text += '}';
  }

 private:
  struct Names {
    std::string field;               ///< "\"active\":"
    std::vector<std::string> parts;  ///< of an object "\"fx\":", else ""
  };

  static void append_field(const ExportedField& field, const std::vector<std::string>& parts,
                           const Number* row, std::string& text) {
    const std::size_t there = field.numbers_in(row);
    const bool is_one = field.components.front().empty();
    const bool is_object = !parts.front().empty();
    if (!is_one) text += is_object ? '{' : '[';
    for (std::size_t i = 0; i < field.width(); ++i) {
      if (i > 0) text += ',';
      text += parts[i];
      if (i < there)
        append_number(field, row[field.first + i], text);
      else
        text += "null";
    }
    if (!is_one) text += is_object ? '}' : ']';
  }

  const ExportedSignal* signal_;
  std::vector<Names> names_;
};

// ---------------------------------------------------------------- file

class McapFile {
 public:
  explicit McapFile(const std::filesystem::path& file) : file_(file) {
    write(magic);
    std::string content;
    append_text("", content);
    append_text("flinch " FLINCH_VERSION, content);
    write(record(header, content));
  }

  void add_channel(const ExportedSignal& signal) {
    const auto number = static_cast<std::uint16_t>(++channels_);
    std::string of_schema, of_channel;
    append_bytes(number, of_schema);
    append_text("flinch." + signal.path, of_schema);
    append_text("jsonschema", of_schema);
    append_text(schema_of(signal), of_schema);
    append_bytes(number, of_channel);
    append_bytes(number, of_channel);
    append_text("/" + signal.path, of_channel);
    append_text("json", of_channel);
    append_bytes(std::uint32_t{0}, of_channel);  // no metadata
    const std::string both = record(schema, of_schema) + record(channel, of_channel);
    summary_ += both;
    write(both);
  }

  /// A message of the channel with this number, counted from 1, for the chunk that is being filled.
  void add_message(std::uint16_t number, std::uint64_t time, const std::string& text) {
    index_[number].emplace_back(time, records_.size());
    std::string content;
    append_bytes(number, content);
    append_bytes(static_cast<std::uint32_t>(counts_[number]++), content);
    append_bytes(time, content);
    append_bytes(time, content);
    records_ += static_cast<char>(message);
    append_bytes(static_cast<std::uint64_t>(content.size() + text.size()), records_);
    records_ += content;
    records_ += text;
    begin_ = records_.size() == content.size() + text.size() + 9 ? time : begin_;
    end_ = time;
  }

  void end_chunk() {
    if (records_.empty()) return;
    std::string content, sizes;
    append_bytes(begin_, content);
    append_bytes(end_, content);
    append_bytes(static_cast<std::uint64_t>(records_.size()), content);
    append_bytes(std::uint32_t{0}, content);  // no checksum
    append_text("", content);                 // not compressed
    append_bytes(static_cast<std::uint64_t>(records_.size()), content);
    const std::uint64_t at = size_;
    write(record(chunk, content + records_));
    const std::uint64_t length = size_ - at;
    std::string offsets;
    for (const auto& [number, entries] : index_) {
      append_bytes(number, offsets);
      append_bytes(size_, offsets);
      write(record(message_index, index_of(number, entries)));
    }
    std::string of_chunk;
    for (const std::uint64_t value : {begin_, end_, at, length}) append_bytes(value, of_chunk);
    append_text(offsets, of_chunk);
    append_bytes(size_ - at - length, of_chunk);
    append_text("", of_chunk);
    append_bytes(static_cast<std::uint64_t>(records_.size()), of_chunk);
    append_bytes(static_cast<std::uint64_t>(records_.size()), of_chunk);
    chunk_indexes_ += record(chunk_index, of_chunk);
    first_ = chunks_++ == 0 ? begin_ : first_;
    records_.clear();
    index_.clear();
  }

  void finish() {
    end_chunk();
    write(record(data_end, std::string(4, '\0')));
    const std::uint64_t begin = size_;
    write(summary_ + chunk_indexes_ + record(statistics, counted()));
    std::string end;
    append_bytes(begin, end);
    end += std::string(12, '\0');  // no offsets of the summary, no checksum
    write(record(footer, end) + magic);
    file_.finish();
  }

 private:
  using Entries = std::vector<std::pair<std::uint64_t, std::uint64_t>>;

  static std::string index_of(std::uint16_t number, const Entries& entries) {
    std::string content, list;
    append_bytes(number, content);
    for (const auto& [time, offset] : entries) {
      append_bytes(time, list);
      append_bytes(offset, list);
    }
    append_text(list, content);
    return content;
  }

  std::string counted() const {
    std::string content, counts;
    std::uint64_t messages = 0;
    for (const auto& [number, count] : counts_) {
      append_bytes(number, counts);
      append_bytes(count, counts);
      messages += count;
    }
    append_bytes(messages, content);
    append_bytes(static_cast<std::uint16_t>(channels_), content);
    append_bytes(static_cast<std::uint32_t>(channels_), content);
    append_bytes(std::uint64_t{0}, content);  // attachments, metadata
    append_bytes(static_cast<std::uint32_t>(chunks_), content);
    append_bytes(first_, content);
    append_bytes(end_, content);
    append_text(counts, content);
    return content;
  }

  void write(const std::string& bytes) {
    file_.write(bytes);
    size_ += bytes.size();
  }

  ResultFile file_;
  std::uint64_t size_ = 0;
  std::size_t channels_ = 0, chunks_ = 0;
  std::string summary_, chunk_indexes_;
  std::string records_;  ///< of the chunk that is being filled
  std::map<std::uint16_t, Entries> index_;
  std::map<std::uint16_t, std::uint64_t> counts_;
  std::uint64_t first_ = 0, begin_ = 0, end_ = 0;  ///< of the file, of the chunk; the last message
};

}  // namespace

void write_mcap(const Recording& recording, const std::vector<ExportedSignal>& signals,
                const std::filesystem::path& file) {
  McapFile mcap(file);
  std::vector<Messages> messages;
  for (const ExportedSignal& signal : signals) {
    mcap.add_channel(signal);
    messages.emplace_back(signal);
  }
  const std::int64_t start =
      recording.time_ns.empty() ? 0 : std::min<std::int64_t>(0, recording.time_ns.front());
  std::string text;
  std::vector<std::vector<Number>> rows(signals.size());
  for (std::size_t first = 0; first < recording.samples(); first += Recording::block) {
    const std::size_t count = std::min(Recording::block, recording.samples() - first);
    for (std::size_t i = 0; i < signals.size(); ++i) {
      rows[i].resize(count * signals[i].signal->layout.numbers);
      recording.read_rows(*signals[i].signal, first, count, rows[i].data());
    }
    for (std::size_t k = 0; k < count; ++k) {
      const auto time = static_cast<std::uint64_t>(recording.time_ns[first + k] - start);
      for (std::size_t i = 0; i < signals.size(); ++i) {
        text.clear();
        messages[i].append(rows[i].data() + k * signals[i].signal->layout.numbers, text);
        mcap.add_message(static_cast<std::uint16_t>(i + 1), time, text);
      }
      if ((k + 1) % samples_of_chunk == 0) mcap.end_chunk();
    }
  }
  mcap.finish();
}

}  // namespace flinch
