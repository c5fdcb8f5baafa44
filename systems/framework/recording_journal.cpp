#include "systems/framework/recording_journal.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <optional>
#include <string_view>
#include <system_error>

#include "systems/foundation/readable_file.h"
#include "systems/foundation/result_file.h"
#include "systems/foundation/setup_error.h"
#include "systems/framework/packed_rows.h"
#include "systems/framework/recording_check.h"

namespace flinch {
namespace {

using internal::Number;

/// "flinch" and what follows: a description, packed samples, or samples as they lay in memory, which earlier
/// versions wrote.
constexpr std::uint64_t description_mark = 0x31'44'68'63'6e'69'6c'66;
constexpr std::uint64_t packed_mark = 0x32'53'68'63'6e'69'6c'66;
constexpr std::uint64_t plain_mark = 0x31'53'68'63'6e'69'6c'66;

constexpr std::uint64_t most_samples = 1 << 24;  ///< of the smallest file; larger ones may have more

struct FrameHead {
  std::uint64_t mark;
  std::uint64_t length;  ///< of the payload, in bytes, a multiple of 8
  std::uint64_t checksum;
};

/// Of 8-byte words: FNV-1a, with words in the place of bytes.
class Checksum {
 public:
  void add(const void* data, std::size_t bytes) {
    const char* const begin = static_cast<const char*>(data);
    for (std::size_t i = 0; i < bytes; i += 8) {
      std::uint64_t word = 0;
      std::memcpy(&word, begin + i, 8);
      value_ = (value_ ^ word) * 0x100000001b3;
      value_ ^= value_ >> 32;
    }
  }
  std::uint64_t value() const { return value_; }

 private:
  std::uint64_t value_ = 0xcbf29ce484222325;
};

std::string reason() { return std::generic_category().message(errno); }

// --- the description as bytes ---

class Bytes {
 public:
  void put(std::int64_t number) { text_.append(reinterpret_cast<const char*>(&number), 8); }
  void put(const std::string& text) {
    put(static_cast<std::int64_t>(text.size()));
    text_ += text;
    text_.resize((text_.size() + 7) / 8 * 8, '\0');
  }
  const std::string& text() const { return text_; }

 private:
  std::string text_;
};

class BytesReader {
 public:
  explicit BytesReader(const std::string& text) : text_(text) {}

  std::int64_t number() {
    std::int64_t value = 0;
    std::memcpy(&value, take(8), 8);
    return value;
  }
  std::string text() {
    const std::int64_t size = number();
    if (size < 0 || static_cast<std::size_t>(size) > text_.size()) throw SetupError("a text has no end");
    const std::string value(take(static_cast<std::size_t>(size)), static_cast<std::size_t>(size));
    at_ = (at_ + 7) / 8 * 8;
    return value;
  }

 private:
  const char* take(std::size_t bytes) {
    if (text_.size() - std::min(at_, text_.size()) < bytes) throw SetupError("the description is too short");
    at_ += bytes;
    return text_.data() + at_ - bytes;
  }

  const std::string& text_;
  std::size_t at_ = 0;
};

std::string bytes_of(const Recording& description) {
  Bytes bytes;
  bytes.put(description.period.count());
  bytes.put(static_cast<std::int64_t>(description.attributes.size()));
  for (const auto& [name, text] : description.attributes) {
    bytes.put(name);
    bytes.put(text);
  }
  bytes.put(static_cast<std::int64_t>(description.signals.size()));
  for (const Signal& signal : description.signals) {
    bytes.put(signal.path);
    bytes.put(static_cast<std::int64_t>(signal.layout.fields.size()));
    for (const Field& field : signal.layout.fields) {
      for (const std::string* const text : {&field.name, &field.unit, &field.frame}) bytes.put(*text);
      bytes.put(static_cast<std::int64_t>(field.kind));
      bytes.put(field.capacity);
      bytes.put(field.resizable ? 1 : 0);
    }
  }
  return bytes.text();
}

Field read_field(BytesReader& bytes) {
  const std::string name = bytes.text(), unit = bytes.text(), frame = bytes.text();
  const std::int64_t kind = bytes.number(), capacity = bytes.number(), resizable = bytes.number();
  return internal::checked_field(name, unit, frame, kind, capacity, resizable);
}

Recording description_of(const std::string& payload) {
  BytesReader bytes(payload);
  Recording description;
  description.period = internal::checked_period(bytes.number());
  for (std::int64_t left = bytes.number(); left > 0; --left) {
    const std::string name = bytes.text();
    description.attributes[name] = bytes.text();
  }
  for (std::int64_t left = bytes.number(); left > 0; --left) {
    Signal signal{bytes.text(), {}, {}};
    for (std::int64_t fields = bytes.number(); fields > 0; --fields) {
      internal::add_field(read_field(bytes), signal.layout);
    }
    description.signals.push_back(std::move(signal));
  }
  return description;
}

// --- files ---

/// Returns false, and errno says why, where the file takes no more.
bool write_all(int file, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::write(file, bytes.data(), bytes.size());
    if (written < 0 && errno != EINTR) return false;
    bytes.remove_prefix(static_cast<std::size_t>(std::max<ssize_t>(written, 0)));
  }
  return true;
}

/// Opens a journal to write, and no file that a link leads to.
int open_own(const std::filesystem::path& part) {
  remove_link(part);
  return open(part.c_str(), O_RDWR | O_CREAT | O_NOFOLLOW | O_CLOEXEC, 0666);
}

/// Reads `bytes` at `offset`; false where the file is too short.
bool read_at(int file, std::uint64_t offset, void* data, std::size_t bytes) {
  char* const begin = static_cast<char*>(data);
  for (std::size_t done = 0; done < bytes;) {
    const ssize_t got = pread(file, begin + done, bytes - done, static_cast<off_t>(offset + done));
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return false;
    done += static_cast<std::size_t>(got);
  }
  return true;
}

/// Hands a frame to the operating system: `frame` has room for the head before the payload.
bool write_frame(int file, std::uint64_t mark, std::string& frame) {
  frame.resize((frame.size() + 7) / 8 * 8, '\0');
  const std::size_t length = frame.size() - sizeof(FrameHead);
  Checksum checksum;
  checksum.add(frame.data() + sizeof(FrameHead), length);
  const FrameHead head{mark, length, checksum.value()};
  std::memcpy(frame.data(), &head, sizeof(head));
  return write_all(file, frame);
}

/// The frame at `offset`, with its payload in `payload`; nothing where it is torn or missing.
std::optional<FrameHead> read_frame(int file, std::uint64_t size, std::uint64_t offset,
                                    std::vector<char>& payload) {
  FrameHead head{};
  if (!read_at(file, offset, &head, sizeof(head))) return std::nullopt;
  if (head.length % 8 != 0 || head.length > size - offset - sizeof(head)) return std::nullopt;
  payload.resize(head.length);
  if (!read_at(file, offset + sizeof(head), payload.data(), head.length)) return std::nullopt;
  Checksum checksum;
  checksum.add(payload.data(), payload.size());
  return checksum.value() == head.checksum ? std::optional(head) : std::nullopt;
}

/// The rows of a journal.
class JournalRows final : public RowSource {
 public:
  explicit JournalRows(const std::filesystem::path& part) : file_(open(part.c_str(), O_RDONLY | O_CLOEXEC)) {
    if (file_ < 0) throw SetupError(reason());
  }
  ~JournalRows() override { close(file_); }
  JournalRows(const JournalRows&) = delete;
  JournalRows& operator=(const JournalRows&) = delete;

  bool is_being_written() const {
    if (flock(file_, LOCK_SH | LOCK_NB) != 0) return true;
    flock(file_, LOCK_UN);
    return false;
  }

  /// Finds all frames that are whole, and says in `recording` what is in them.
  void read_frames(Recording& recording) {
    struct stat status {};
    if (fstat(file_, &status) != 0) throw SetupError(reason());
    const auto size = static_cast<std::uint64_t>(status.st_size);
    std::vector<char> payload;
    std::optional<FrameHead> head = read_frame(file_, size, 0, payload);
    if (!head || head->mark != description_mark) throw SetupError("the run was killed before it began");
    recording = description_of(std::string(payload.begin(), payload.end()));
    parts_ = {{0, 1}};  // the time
    for (const Signal& signal : recording.signals) {
      const Part& last = parts_.back();
      parts_.push_back({last.before + last.numbers, signal.layout.numbers});
      const bool is_new = part_of_.emplace(signal.path, parts_.size() - 1).second;
      if (!is_new) throw SetupError("there are two signals '" + signal.path + "'");
    }
    for (std::uint64_t offset = sizeof(FrameHead) + head->length;;
         offset += sizeof(FrameHead) + head->length) {
      head = read_frame(file_, size, offset, payload);
      if (!head || head->length < 8) return;
      Frame frame{recording.samples(), 0, offset + sizeof(FrameHead), head->length,
                  head->mark == packed_mark};
      std::memcpy(&frame.samples, payload.data(), 8);
      if (!frame.is_packed && (head->mark != plain_mark || !has_plain_samples(frame))) return;
      if (frame.samples > most_samples + size / 2 - recording.samples())
        throw SetupError("there are more than " + std::to_string(most_samples) +
                         " samples in so small a file");
      frames_.push_back(frame);
      const std::vector<char> times = rows_of(frame, 0);
      recording.time_ns.resize(recording.samples() + frame.samples);
      std::memcpy(recording.time_ns.data() + frame.first, times.data(), times.size());
    }
  }

  void read(const std::string& path, std::size_t first, std::size_t count, Number* rows) const override {
    if (count == 0) return;  // there may be no frame
    const std::size_t part = part_of_.at(path);
    const std::size_t row = 8 * parts_[part].numbers;
    auto frame = std::upper_bound(frames_.begin(), frames_.end(), first,
                                  [](std::size_t sample, const Frame& each) { return sample < each.first; });
    for (--frame; count > 0; ++frame) {
      const std::size_t skipped = first - frame->first;
      const std::size_t taken = std::min<std::size_t>(count, frame->samples - skipped);
      const std::vector<char> all = rows_of(*frame, part);
      std::memcpy(rows, all.data() + skipped * row, taken * row);
      first += taken;
      count -= taken;
      rows += taken * parts_[part].numbers;
    }
  }

 private:
  /// Samples first ... first + samples of the recording.
  struct Frame {
    std::size_t first;
    std::uint64_t samples;
    std::uint64_t offset;  ///< of its payload in the file
    std::uint64_t length;  ///< of that [bytes]
    bool is_packed;
  };
  /// The time or a signal, in a sample.
  struct Part {
    std::size_t before;  ///< numbers of the parts before it
    std::size_t numbers;
  };

  bool has_plain_samples(const Frame& frame) const {
    const std::size_t numbers = parts_.back().before + parts_.back().numbers;
    return frame.samples == (frame.length - 8) / 8 / numbers &&
           frame.length == 8 + 8 * frame.samples * numbers;
  }

  void read_or_fail(std::uint64_t offset, void* data, std::size_t bytes) const {
    if (!read_at(file_, offset, data, bytes)) throw SetupError("a frame has been cut off");
  }

  /// All rows of a part of a frame, one behind the other.
  std::vector<char> rows_of(const Frame& frame, std::size_t part) const {
    const auto& [before, numbers] = parts_[part];
    if (!frame.is_packed) {
      std::vector<char> rows(8 * frame.samples * numbers);
      read_or_fail(frame.offset + 8 + 8 * before * frame.samples, rows.data(), rows.size());
      return rows;
    }
    std::vector<std::uint64_t> lengths(parts_.size());
    std::uint64_t begin = 8 + 8 * lengths.size();
    if (frame.length < begin) throw SetupError("a frame is too short for its signals");
    read_or_fail(frame.offset + 8, lengths.data(), 8 * lengths.size());
    for (std::size_t i = 0; i <= part; ++i) {
      if (lengths[i] > frame.length - begin) throw SetupError("a frame is too short for its signals");
      begin += i < part ? lengths[i] : 0;
    }
    std::string packed(lengths[part], '\0');
    read_or_fail(frame.offset + begin, packed.data(), packed.size());
    return internal::unpacked_rows(packed, frame.samples, numbers);
  }

  int file_;
  std::vector<Frame> frames_;
  std::vector<Part> parts_;
  std::map<std::string, std::size_t> part_of_;
};

std::string how_far(const Recording& recording, bool goes_on) {
  const double seconds =
      recording.samples() == 0
          ? 0.0
          : to_seconds(Time(recording.time_ns.back() - recording.time_ns.front()) + recording.period);
  std::array<char, 40> text{};
  std::snprintf(text.data(), text.size(), "%.3f s", seconds);
  return goes_on ? "the run still goes on; so far " + std::string(text.data()) + " are recorded"
                 : "the run was killed; only its first " + std::string(text.data()) + " are recorded";
}

}  // namespace

RecordingJournal::RecordingJournal(const Recording& description, const std::filesystem::path& part)
    : part_(part), file_(open_own(part)) {
  const auto fail = [this](const std::string& why) {
    if (file_ >= 0) close(file_);
    throw SetupError(part_.string() + ": the recording cannot be written: " + why);
  };
  if (file_ < 0) fail(reason());
  if (flock(file_, LOCK_EX | LOCK_NB) != 0) fail("another run is recording into it");
  std::string frame = std::string(sizeof(FrameHead), '\0') + bytes_of(description);
  if (ftruncate(file_, 0) == 0 && write_frame(file_, description_mark, frame)) return;
  const std::string why = reason();
  remove_unfinished(part);  // nothing can be read from it
  fail(why);
}

RecordingJournal::~RecordingJournal() { close(file_); }

void RecordingJournal::append(const SampleBlock& samples) {
  const std::uint64_t count = samples.samples();
  std::vector<internal::RowsInMemory> parts = {
      {reinterpret_cast<const char*>(samples.time_ns.data()), 1, sizeof(Number)}};
  for (const SampleRows& each : samples.rows)
    parts.push_back({reinterpret_cast<const char*>(each.first), each.numbers, each.stride * sizeof(Number)});
  const std::size_t head = sizeof(FrameHead) + sizeof(count);
  frame_.assign(head + 8 * parts.size(), '\0');
  std::memcpy(frame_.data() + sizeof(FrameHead), &count, sizeof(count));
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const std::uint64_t before = frame_.size();
    packer_.pack(parts[i], count, frame_);
    const std::uint64_t length = frame_.size() - before;
    std::memcpy(frame_.data() + head + 8 * i, &length, sizeof(length));
  }
  if (write_frame(file_, packed_mark, frame_)) return;
  throw SetupError(part_.string() + ": the recording cannot be written: " + reason());
}

std::filesystem::path part_name(const std::filesystem::path& file) { return file.string() + ".part"; }

bool is_journal(const std::filesystem::path& file) {
  if (!problem_with_reading(file).empty()) return false;
  std::uint64_t mark = 0;
  std::ifstream(file, std::ios::binary).read(reinterpret_cast<char*>(&mark), sizeof(mark));
  return mark == description_mark;
}

Recording open_journal(const std::filesystem::path& part) {
  try {
    const std::string problem = problem_with_reading(part);
    if (!problem.empty()) throw SetupError(problem);
    const auto rows = std::make_shared<JournalRows>(part);
    Recording recording;
    rows->read_frames(recording);
    internal::check_times(recording.time_ns);
    recording.attributes["recording.partial"] = how_far(recording, rows->is_being_written());
    recording.source = rows;
    return recording;
  } catch (const SetupError& failure) {
    throw SetupError(part.string() + ": this is no flinch recording: " + failure.what());
  }
}

}  // namespace flinch
