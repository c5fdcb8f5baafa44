#include "systems/framework/recording_journal.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <sys/uio.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <climits>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <optional>
#include <system_error>

#include "systems/foundation/readable_file.h"
#include "systems/foundation/result_file.h"
#include "systems/foundation/setup_error.h"
#include "systems/framework/recording_check.h"

namespace flinch {
namespace {

using internal::Number;

/// "flinch" and what follows: a description, or samples.
constexpr std::uint64_t description_mark = 0x31'44'68'63'6e'69'6c'66;
constexpr std::uint64_t samples_mark = 0x31'53'68'63'6e'69'6c'66;

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

/// Pieces of memory that are written one after the other.
class Gathered {
 public:
  void add(const void* data, std::size_t bytes) {
    if (bytes > 0) pieces_.push_back({const_cast<void*>(data), bytes});  // NOLINT: writev() only reads
  }
  void add(const Gathered& others) {
    pieces_.insert(pieces_.end(), others.pieces_.begin(), others.pieces_.end());
  }
  std::uint64_t length() const {
    std::uint64_t sum = 0;
    for (const iovec& piece : pieces_) sum += piece.iov_len;
    return sum;
  }
  std::uint64_t checksum() const {
    Checksum checksum;
    for (const iovec& piece : pieces_) checksum.add(piece.iov_base, piece.iov_len);
    return checksum.value();
  }
  /// Returns false, and errno says why, where the file takes no more.
  bool write_to(int file) {
    for (std::size_t next = 0; next < pieces_.size();) {
      const auto count = static_cast<int>(std::min<std::size_t>(pieces_.size() - next, IOV_MAX));
      ssize_t written = writev(file, pieces_.data() + next, count);
      if (written < 0 && errno != EINTR) return false;
      for (written = std::max<ssize_t>(written, 0); next < pieces_.size(); ++next) {
        iovec& piece = pieces_[next];
        const auto part = std::min(static_cast<std::size_t>(written), piece.iov_len);
        piece.iov_base = static_cast<char*>(piece.iov_base) + part;
        piece.iov_len -= part;
        written -= static_cast<ssize_t>(part);
        if (piece.iov_len > 0) break;
      }
    }
    return true;
  }

 private:
  std::vector<iovec> pieces_;
};

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

/// Hands a frame to the operating system in as few calls as it takes.
bool write_frame(int file, std::uint64_t mark, const Gathered& payload) {
  const FrameHead head{mark, payload.length(), payload.checksum()};
  Gathered frame;
  frame.add(&head, sizeof(head));
  frame.add(payload);
  return frame.write_to(file);
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
    std::size_t numbers = 1;  // the time
    for (const Signal& signal : recording.signals) {
      const bool is_new = places_.emplace(signal.path, Place{numbers, signal.layout.numbers}).second;
      if (!is_new) throw SetupError("there are two signals '" + signal.path + "'");
      numbers += signal.layout.numbers;
    }
    for (std::uint64_t offset = sizeof(FrameHead) + head->length;;
         offset += sizeof(FrameHead) + head->length) {
      head = read_frame(file_, size, offset, payload);
      if (!head || head->mark != samples_mark || head->length < 8) return;
      std::uint64_t samples = 0;
      std::memcpy(&samples, payload.data(), 8);
      if (samples != (head->length - 8) / 8 / numbers || head->length != 8 + 8 * samples * numbers) return;
      frames_.push_back({recording.samples(), samples, offset + sizeof(FrameHead) + 8});
      recording.time_ns.resize(recording.samples() + samples);
      std::memcpy(recording.time_ns.data() + frames_.back().first, payload.data() + 8, 8 * samples);
    }
  }

  void read(const std::string& path, std::size_t first, std::size_t count, Number* rows) const override {
    if (count == 0) return;  // there may be no frame
    const Place& place = places_.at(path);
    auto frame = std::upper_bound(frames_.begin(), frames_.end(), first,
                                  [](std::size_t sample, const Frame& each) { return sample < each.first; });
    for (--frame; count > 0; ++frame) {
      const std::size_t skipped = first - frame->first;
      const std::size_t taken = std::min(count, frame->samples - skipped);
      const std::uint64_t offset =
          frame->offset + 8 * (place.before * frame->samples + skipped * place.numbers);
      if (!read_at(file_, offset, rows, 8 * taken * place.numbers))
        throw SetupError("a frame has been cut off");
      first += taken;
      count -= taken;
      rows += taken * place.numbers;
    }
  }

 private:
  /// Samples first ... first + samples of the recording.
  struct Frame {
    std::size_t first;
    std::size_t samples;
    std::uint64_t offset;  ///< of their times in the file
  };
  /// Of a signal in a sample.
  struct Place {
    std::size_t before;  ///< numbers of the time and the signals before it
    std::size_t numbers;
  };

  int file_;
  std::vector<Frame> frames_;
  std::map<std::string, Place> places_;
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
  const std::string text = bytes_of(description);
  Gathered payload;
  payload.add(text.data(), text.size());
  if (ftruncate(file_, 0) != 0 || !write_frame(file_, description_mark, payload)) fail(reason());
}

RecordingJournal::~RecordingJournal() { close(file_); }

void RecordingJournal::append(const SampleBlock& samples) {
  const std::uint64_t count = samples.samples();
  Gathered payload;
  payload.add(&count, sizeof(count));
  payload.add(samples.time_ns.data(), samples.time_ns.size_bytes());
  std::size_t numbers = 0;
  for (const SampleRows& each : samples.rows) numbers += count * each.numbers;
  std::vector<Number> rows;
  rows.reserve(numbers);
  for (const SampleRows& each : samples.rows) {
    for (std::size_t k = 0; k < count; ++k) rows.insert(rows.end(), each[k].begin(), each[k].end());
  }
  payload.add(rows.data(), rows.size() * sizeof(Number));
  if (write_frame(file_, samples_mark, payload)) return;
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
