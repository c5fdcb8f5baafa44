#include "systems/framework/recording_stream.h"

#include "systems/foundation/result_file.h"
#include "systems/framework/recorder.h"

namespace flinch {

RecordingStream::RecordingStream(Recorder& recorder, const std::filesystem::path& file,
                                 std::map<std::string, std::string> attributes)
    : recorder_(recorder), file_(file), attributes_(std::move(attributes)) {
  const Recording description = recorder.description(attributes_);
  journal_.emplace(description, part_name(file));
  try {
    writer_.emplace(description, file);
  } catch (const SetupError&) {
    remove_journal();
    throw;
  }
  thread_ = std::thread([this] { run(); });
}

RecordingStream::~RecordingStream() {
  stop();
  if (journal_ && !has_samples_) remove_journal();
}

void RecordingStream::remove_journal() {
  journal_.reset();
  remove_unfinished(part_name(file_));
}

void RecordingStream::run() {
  bool stops = false;
  while (!stops) {
    {
      std::unique_lock lock(mutex_);
      wake_.wait_for(lock, longest_wait, [this] { return stops_ || hurries_; });
      stops = stops_;  // what is there then is all
      hurries_ = false;
    }
    try {
      drain();
    } catch (const SetupError& error) {
      const std::lock_guard lock(mutex_);
      failure_ = error;
      stops = true;
    }
    room_.notify_all();
  }
}

void RecordingStream::drain() {
  for (SampleBlock oldest = recorder_.front(); oldest.samples() > 0; oldest = recorder_.front()) {
    journal_->append(oldest);
    has_samples_ = true;
    writer_->append(oldest);
    recorder_.pop(oldest.samples());
    room_.notify_all();
  }
}

void RecordingStream::stop() {
  if (!thread_.joinable()) return;
  {
    const std::lock_guard lock(mutex_);
    stops_ = true;
  }
  wake_.notify_all();
  thread_.join();
}

void RecordingStream::wait_for_room() {
  const auto has_room = [this] { return 2 * recorder_.samples() <= recorder_.capacity(); };
  if (has_room()) return;
  std::unique_lock lock(mutex_);
  hurries_ = true;
  wake_.notify_all();
  while (!failure_ && !has_room()) room_.wait_for(lock, longest_wait);
  if (failure_) throw SetupError(*failure_);
}

void RecordingStream::finish(const std::map<std::string, std::string>& attributes) {
  stop();
  if (failure_) throw SetupError(*failure_);
  attributes_.insert(attributes.begin(), attributes.end());
  if (recorder_.dropped() > 0) attributes_["recording.dropped"] = std::to_string(recorder_.dropped());
  writer_->finish(attributes_);
  remove_journal();
}

}  // namespace flinch
