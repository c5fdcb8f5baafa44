#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <filesystem>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "systems/foundation/setup_error.h"
#include "systems/framework/recording_file.h"
#include "systems/framework/recording_journal.h"

namespace flinch {

class Recorder;

/// Takes the samples of a Recorder to a file while they come, on a thread of its own. So a run needs no more
/// memory than the recorder's ring, however long it is, and one that is killed has lost at most what came in
/// the last half second.
///
/// Every `longest_wait`, and when the ring is half full, the thread takes what is there and writes it, in
/// this order: to the journal (RecordingJournal, "run.h5.part"), from which a killed run can be read; then
/// to the HDF5 file, which has another name and cannot be read until it is whole; then it gives the place
/// in the ring free. finish() writes the rest, completes the HDF5 file, gives it its name ("run.h5"), by
/// which it replaces an older one, and last removes the journal.
///
///   Recorder recorder(diagram, paths, RecordingStream::ring);
///   RecordingStream stream(recorder, "run.h5", attributes);
///   simulator.record(recorder);
///   while (context.time() < end) {
///     stream.wait_for_room();  // only in simulated time
///     simulator.step(context);
///   }
///   stream.finish();
///
/// In real time nobody waits: where the disk does not keep up, the ring gets full and the recorder counts
/// what it drops; finish() says how many in the attribute "recording.dropped". In simulated time, whoever
/// drives the simulation calls wait_for_room() between two ticks.
class RecordingStream {
 public:
  /// A size for the recorder's ring: 8 s at 1 kHz.
  static constexpr std::size_t ring = 8192;
  static constexpr std::chrono::milliseconds longest_wait{100};

  /// `attributes`: those that are known before the run. The recorder must outlive the stream. Throws
  /// SetupError naming the file where it cannot be written.
  RecordingStream(Recorder& recorder, const std::filesystem::path& file,
                  std::map<std::string, std::string> attributes = {});
  /// Without finish(): writes what is there; the journal stays where it has samples.
  ~RecordingStream();

  /// Returns when at least half of the ring is free. Throws SetupError where the file cannot be written.
  void wait_for_room();

  /// Makes the file whole, with `attributes` besides those from before the run. After the run; once. Throws
  /// SetupError where it cannot be written; the journal stays then.
  void finish(const std::map<std::string, std::string>& attributes = {});

 private:
  void run();
  void drain();
  void stop();
  void remove_journal();

  Recorder& recorder_;
  std::filesystem::path file_;
  std::map<std::string, std::string> attributes_;
  std::optional<RecordingJournal> journal_;
  std::optional<RecordingFileWriter> writer_;
  bool has_samples_ = false;  ///< of the thread

  std::mutex mutex_;  ///< of what follows; record() never takes it
  std::condition_variable wake_;
  std::condition_variable room_;
  bool stops_ = false;
  bool hurries_ = false;
  std::optional<SetupError> failure_;
  std::thread thread_;  ///< the last: it sees all others
};

}  // namespace flinch
