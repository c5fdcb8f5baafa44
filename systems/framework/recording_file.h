#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>

#include "systems/foundation/result_file.h"
#include "systems/framework/recording.h"

namespace flinch {

/// Writes a recording as HDF5, some samples at a time: a group for each port path, in it a dataset for each
/// field (samples x numbers) with the attributes unit, frame and period_ns; fields that change size have a
/// second dataset NAME.size (rows, columns). The dataset /time_ns holds the time of each sample; the
/// attributes of the root are those of the recording.
///
/// Equal recordings make equal files, byte for byte, however many samples came at a time: nothing in a file
/// depends on when or where it was written. Until finish() an older file keeps the name (see ResultFile).
class RecordingFileWriter {
 public:
  /// Of `description` only period and signals are used. Throws SetupError naming the file, as all do here.
  RecordingFileWriter(const Recording& description, const std::filesystem::path& file);
  /// Without finish() nothing is left of the file.
  ~RecordingFileWriter();

  void append(const SampleBlock& samples);

  /// Writes what is left, and lets the file replace an older one.
  void finish(const std::map<std::string, std::string>& attributes);

 private:
  class Tables;

  void write_block();
  /// Does `work`; names the file where that fails.
  template <class Work>
  void telling_file(const Work& work) const;

  std::filesystem::path file_;
  ResultFile result_;
  Recording block_;  ///< samples that wait until there are enough for a chunk
  std::unique_ptr<Tables> tables_;
  bool is_empty_ = true;
};

/// Reads every row of every signal, block by block. Throws SetupError where one cannot be read.
void read_every_row(const Recording& recording);

}  // namespace flinch
