#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "systems/framework/fields.h"
#include "systems/framework/sample_block.h"
#include "systems/framework/time.h"

namespace flinch {

/// One recorded port: rows of numbers as write_row() lays them out, one a sample.
struct Signal {
  std::string path;  ///< of the port in its diagram: "station/encoders/joints"
  RowLayout layout;
  std::vector<internal::Number> rows;  ///< samples x layout.numbers; empty where they lie in a RowSource
};

/// Where the rows of a recording lie that are not in memory: a file.
class RowSource {
 public:
  using Rows = std::vector<internal::Number>;

  RowSource() = default;
  RowSource(const RowSource&) = delete;
  RowSource& operator=(const RowSource&) = delete;
  virtual ~RowSource() = default;

  /// Copies `count` rows of the signal `path`, from sample `first` on, to `rows`. Throws SetupError naming
  /// what is missing or broken.
  virtual void read(const std::string& path, std::size_t first, std::size_t count,
                    internal::Number* rows) const = 0;

  /// The same rows, `width` numbers each. Those that were read last of a signal are shared with all who ask
  /// while somebody holds them. From any thread.
  std::shared_ptr<const Rows> shared(const std::string& path, std::size_t first, std::size_t count,
                                     std::size_t width) const;

 private:
  struct Last {
    std::size_t first = 0;
    std::weak_ptr<const Rows> rows;
  };
  mutable std::mutex mutex_;
  mutable std::map<std::string, Last> last_;  ///< by signal
};

/// What a Recorder has seen: signals with a common time axis, and what made them.
///
/// A recording of an hour has some gigabytes. One that open_recording() returns leaves its rows in the file;
/// what reads it block by block (read<T>(), column()) needs little memory however long it is.
struct Recording {
  /// Rows that are read at once; those of a file lie together in as many.
  static constexpr std::size_t block = 4096;

  Time period{};
  std::vector<std::int64_t> time_ns;
  std::map<std::string, std::string> attributes;  ///< what made it: version, seed, robot file, scenario, ...
  std::vector<Signal> signals;
  std::shared_ptr<const RowSource> source;  ///< of signals whose rows are empty; null where there is none

  std::size_t samples() const { return time_ns.size(); }

  /// The signal of the port `path`; null where there is none.
  const Signal* find(const std::string& path) const;
  /// The same; throws SetupError naming the nearest path where there is none.
  const Signal& signal(const std::string& path) const;

  /// Copies `count` rows of `signal`, from sample `first` on, to `rows`, wherever they lie.
  void read_rows(const Signal& signal, std::size_t first, std::size_t count, internal::Number* rows) const;
  /// The same of a signal whose rows lie in the source, shared as it says. Throws SetupError where there is
  /// none.
  std::shared_ptr<const RowSource::Rows> shared_rows(const Signal& signal, std::size_t first,
                                                     std::size_t count) const;

  /// Column `element` of `field` ("joints.active") of the port `path`, as real numbers; NaN where it was
  /// shorter.
  std::vector<double> column(const std::string& path, const std::string& field, int element = 0) const;

  /// Appends samples to the rows in memory.
  void append(const SampleBlock& samples);
};

/// Writes `recording` to `file`, first under another name, so that an older file is replaced only by a whole
/// new one. Throws SetupError when that fails.
void write_recording(const Recording& recording, const std::filesystem::path& file);

/// Opens a recording; its rows stay in the file until they are read. Where there is no such file but what a
/// killed run has left of it (see recording_journal.h), opens that, and the attribute "recording.partial"
/// says so. Throws SetupError naming the file and what is missing or broken.
Recording open_recording(const std::filesystem::path& file);

/// The same, with all rows in memory.
Recording read_recording(const std::filesystem::path& file);

}  // namespace flinch
