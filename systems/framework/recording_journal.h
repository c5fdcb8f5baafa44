#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "systems/framework/packed_rows.h"
#include "systems/framework/recording.h"

namespace flinch {

/// Keeps the samples of a run under way, so that nothing is lost when the program is killed at any moment.
///
/// A journal only ever grows: what was written is never changed again. It is a row of frames, each of which
/// says how long it is and has a checksum. The first holds what the recording is (period, signals,
/// attributes), each other one some samples. append() hands one frame to the operating system and returns
/// when that has it. A program that is killed leaves whole frames and at most one that is torn, the last; a
/// reader stops there. What the operating system has is lost only when the computer itself stops.
///
/// A frame is: 8 bytes of mark, 8 of length, 8 of checksum, and the payload of that length. The payload of
/// samples is their number n, the lengths of what follows, their n times, and for each signal its n rows,
/// each of these packed by itself (RowPacker): so a journal takes about as much room as the recording, and a
/// signal can be read alone.
class RecordingJournal {
 public:
  /// Begins the journal of `description`. An older one of this name is replaced, unless another program is
  /// writing it. Throws SetupError naming the file, as append() does.
  RecordingJournal(const Recording& description, const std::filesystem::path& part);
  /// Leaves the file as it is.
  ~RecordingJournal();
  RecordingJournal(const RecordingJournal&) = delete;
  RecordingJournal& operator=(const RecordingJournal&) = delete;

  void append(const SampleBlock& samples);

 private:
  std::filesystem::path part_;
  int file_;
  internal::RowPacker packer_;
  std::string frame_;  ///< Kept, so that its memory serves the next.
};

/// "run.h5.part" for "run.h5": the journal of the run whose recording will be that file.
std::filesystem::path part_name(const std::filesystem::path& file);

/// Whether a file begins as a journal does.
bool is_journal(const std::filesystem::path& file);

/// Opens what a run has recorded so far. Its attribute "recording.partial" says how far, and whether the run
/// still goes on. Throws SetupError naming the file and what is broken.
Recording open_journal(const std::filesystem::path& part);

}  // namespace flinch
