#include "experiments/dataset/data_journal.h"

#include <fmt/core.h>

#include <cstring>
#include <system_error>
#include <utility>

#include "experiments/dataset/data_spec.h"
#include "systems/foundation/fnv1a.h"
#include "systems/foundation/journal_file.h"
#include "systems/foundation/result_file.h"
#include "systems/foundation/setup_error.h"

namespace flinch {
namespace {

template <class Number>
void put(std::string& bytes, Number number) {
  bytes.append(reinterpret_cast<const char*>(&number), sizeof number);
}

template <class Vector>
void put_all(std::string& bytes, const Vector& numbers) {
  for (const double number : numbers) put(bytes, number);
}

/// Numbers of a frame, one after the other; 0 behind its end.
class Frame {
 public:
  explicit Frame(const std::string& bytes) : bytes_(bytes) {}
  template <class Number>
  Number take() {
    Number number{};
    if (at_ + sizeof number <= bytes_.size()) std::memcpy(&number, bytes_.data() + at_, sizeof number);
    at_ += sizeof number;
    return number;
  }
  template <class Vector>
  void take_all(Eigen::Index size, Vector& into) {
    into.resize(size);
    for (double& number : into) number = take<double>();
  }
  bool has_more() const { return at_ < bytes_.size(); }
  bool ended() const { return at_ == bytes_.size(); }

 private:
  const std::string& bytes_;
  std::size_t at_ = 0;
};

std::string frame_of(std::size_t run, const ContactSamples& samples) {
  std::string bytes;
  put(bytes, static_cast<std::uint64_t>(run));
  put(bytes, static_cast<std::uint64_t>(samples.left_out.size()));
  bytes += samples.left_out;
  put(bytes, static_cast<std::uint64_t>(samples.samples.size()));
  for (const DataSample& sample : samples.samples) {
    for (const int number : {sample.configuration, sample.moment, sample.touched}) put(bytes, number);
    for (const double number : {sample.since_onset, sample.since_early, sample.force}) put(bytes, number);
    put_all(bytes, sample.pose);
    for (const ContactMoment& moment : sample.course) {
      put_all(bytes, moment.wrench_in_base);
      put_all(bytes, moment.velocity);
    }
  }
  return bytes;
}

/// Nothing where the frame has another length than its samples.
std::optional<std::pair<std::size_t, ContactSamples>> run_of(const std::string& bytes,
                                                             const ParallelRobot& robot) {
  Frame frame(bytes);
  const auto run = static_cast<std::size_t>(frame.take<std::uint64_t>());
  ContactSamples samples;
  for (auto letters = frame.take<std::uint64_t>(); letters > 0 && frame.has_more(); --letters)
    samples.left_out += frame.take<char>();
  const auto count = frame.take<std::uint64_t>();
  for (std::uint64_t i = 0; i < count && frame.has_more(); ++i) {
    DataSample& sample = samples.samples.emplace_back();
    sample.run = static_cast<int>(run);
    for (int* const number : {&sample.configuration, &sample.moment, &sample.touched})
      *number = frame.take<int>();
    for (double* const number : {&sample.since_onset, &sample.since_early, &sample.force})
      *number = frame.take<double>();
    frame.take_all(robot.home_pose().size(), sample.pose);
    for (ContactMoment& moment : sample.course) {
      frame.take_all(robot.dof(), moment.wrench_in_base);
      frame.take_all(robot.dof(), moment.velocity);
    }
  }
  if (!frame.ended()) return std::nullopt;
  return std::pair(run, std::move(samples));
}

std::string sealed(const std::string& frame) {
  std::string bytes;
  put(bytes, static_cast<std::uint64_t>(frame.size()));
  put(bytes, fnv1a(frame));
  return bytes + frame;
}

}  // namespace

DataJournal::DataJournal(std::filesystem::path file, const DataSpec& spec, const ParallelRobot& robot)
    : file_(std::move(file)) {
  const std::string header = fmt::format("flinch data set 2 {:016x}\n", fnv1a(spec.identity()));
  remove_link(file_);
  if (std::filesystem::exists(file_)) read(header, robot);
  // Written anew, so that what follows does not stand behind half a frame.
  begin_journal(file_, stream_, [&] {
    stream_ << header;
    for (const auto& [run, samples] : runs_) stream_ << sealed(frame_of(run, samples));
  });
}

void DataJournal::read(const std::string& header, const ParallelRobot& robot) {
  const std::uint64_t longest = std::filesystem::file_size(file_);
  std::ifstream stream(file_, std::ios::binary);
  std::string line;
  if (!std::getline(stream, line)) return;
  if (line + "\n" != header) {
    throw SetupError(file_.string() +
                     ": holds the samples of another specification, seed or version; choose "
                     "another file with --out, or begin anew with --fresh");
  }
  std::uint64_t start[2] = {0, 0};  // length and checksum
  while (stream.read(reinterpret_cast<char*>(start), sizeof start) && start[0] < longest) {
    std::string frame(start[0], '\0');
    if (!stream.read(frame.data(), static_cast<std::streamsize>(frame.size())) || fnv1a(frame) != start[1])
      return;
    const auto run = run_of(frame, robot);
    if (!run)
      throw SetupError(file_.string() +
                       ": holds a run of another length than its samples; begin anew with --fresh");
    runs_.insert(*run);
  }
}

std::optional<std::size_t> DataJournal::first_with_samples() const {
  for (const auto& [run, samples] : runs_)
    if (!samples.samples.empty()) return run;
  return std::nullopt;
}

void DataJournal::require_same(std::size_t run, const ContactSamples& made) const {
  if (frame_of(run, runs_.at(run)) == frame_of(run, made)) return;
  throw SetupError(
      fmt::format("{}: run {} comes out otherwise now: another build of the program has made it, or "
                  "what the runs are made of has changed; begin anew with --fresh",
                  file_.string(), run));
}

void DataJournal::add(std::size_t run, const ContactSamples& samples) {
  stream_ << sealed(frame_of(run, samples));
  if (!stream_.flush()) {
    throw SetupError(file_.string() +
                     ": the disk takes no more; what is done is kept, go on with the same call");
  }
  runs_.insert_or_assign(run, samples);
}

void DataJournal::remove() {
  stream_.close();
  std::error_code ignored;
  std::filesystem::remove(file_, ignored);
}

}  // namespace flinch
