#include "tests/systems/framework/killed_run.h"

#include <gtest/gtest.h>
#include <sys/mman.h>

#include <atomic>
#include <cstring>
#include <memory>
#include <thread>
#include <vector>

#include "systems/foundation/setup_error.h"
#include "systems/framework/diagram.h"
#include "systems/framework/monotonic_clock.h"
#include "systems/framework/recorder.h"
#include "systems/framework/recording_stream.h"
#include "systems/framework/simulator.h"
#include "tests/support/other_program.h"
#include "tests/systems/framework/random_source.h"

namespace flinch::test {
namespace {

/// What a run tells of itself, in memory that it shares with the test.
struct Told {
  std::atomic<std::uint64_t> recorded = 0;  ///< samples
  std::atomic<std::uint64_t> finished = 0;  ///< recordings
};

class Shared {
 public:
  Shared() : memory_(mmap(nullptr, sizeof(Told), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0)) {
    ::new (memory_) Told;
  }
  ~Shared() { munmap(memory_, sizeof(Told)); }
  Shared(const Shared&) = delete;
  Shared& operator=(const Shared&) = delete;
  Told& operator*() const { return *static_cast<Told*>(memory_); }

 private:
  void* memory_;
};

void kill_at_once(OtherProgram& program) {
  EXPECT_TRUE(program.is_running()) << "the run ended by itself";
  program.kill();
  while (program.is_running()) std::this_thread::sleep_for(100us);
}

void run_forever(Pace pace, const std::filesystem::path& file, Told& told) {
  const auto diagram = random_source();
  Recorder recorder(*diagram, recordable_paths(*diagram), RecordingStream::ring);
  RecordingStream stream(recorder, file, {{"seed", "3"}});
  Simulator simulator(*diagram);
  simulator.record(recorder);
  Context context = diagram->make_context();
  const int ticks_at_a_time = pace == Pace::real_time ? 1 : 20;
  for (Time due = MonotonicClock::now();; due += 1ms) {
    MonotonicClock::sleep_until(due);
    for (int tick = 0; tick < ticks_at_a_time; ++tick) {
      if (pace == Pace::as_fast_as_possible) stream.wait_for_room();
      simulator.step(context);
      ++told.recorded;
    }
  }
}

void record_over_and_over(const std::filesystem::path& file, Told& told) {
  const auto diagram = random_source();
  for (;;) {
    Recorder recorder(*diagram, recordable_paths(*diagram), 300);
    RecordingStream stream(recorder, file);
    Simulator simulator(*diagram);
    simulator.record(recorder);
    Context context = diagram->make_context();
    simulator.advance_to(context, 300ms);
    told.recorded = 300;
    stream.finish();
    ++told.finished;
  }
}

Recording left_alone(std::size_t samples) {
  const auto diagram = random_source();
  Recorder recorder(*diagram, recordable_paths(*diagram), samples);
  Simulator simulator(*diagram);
  simulator.record(recorder);
  Context context = diagram->make_context();
  simulator.advance_to(context, static_cast<Time::rep>(samples) * Time(1ms));
  return recorder.recording();
}

void expect_beginning_of_the_run(const Recording& recording) {
  const Recording whole = left_alone(recording.samples());
  EXPECT_EQ(recording.time_ns, whole.time_ns);
  for (const Signal& signal : whole.signals) {
    std::vector<internal::Number> rows(signal.rows.size());
    recording.read_rows(recording.signal(signal.path), 0, recording.samples(), rows.data());
    EXPECT_TRUE(rows.empty() || std::memcmp(rows.data(), signal.rows.data(), 8 * rows.size()) == 0)
        << signal.path;
  }
}

/// One run, and how many samples it had recorded when.
struct Victim {
  Victim(Pace pace, std::filesystem::path where, Time alive)
      : file(std::move(where)),
        process([&] { run_forever(pace, file, *told); }),
        end(MonotonicClock::now() + alive) {}

  Shared told;
  std::filesystem::path file;
  OtherProgram process;
  Time end;
  std::vector<std::pair<Time, std::uint64_t>> history;
  bool is_alive = true;
};

void inspect(const Victim& victim, Time killed) {
  std::uint64_t wanted = 0;
  for (const auto& [time, recorded] : victim.history) {
    if (time <= killed - 1s) wanted = recorded;
  }
  if (wanted == 0 && !std::filesystem::exists(part_name(victim.file))) return;  // it had hardly begun
  try {
    const Recording recording = open_recording(victim.file);
    EXPECT_GE(recording.samples(), wanted);
    EXPECT_TRUE(recording.attributes.at("recording.partial").starts_with("the run was killed"));
    expect_beginning_of_the_run(recording);
  } catch (const SetupError& error) {
    EXPECT_EQ(wanted, 0U) << error.what();
  }
}

}  // namespace

void kill_runs(int count, std::uint64_t seed, Pace pace, const std::filesystem::path& folder) {
  RandomGenerator random(seed);
  std::vector<std::unique_ptr<Victim>> victims;
  for (int i = 0; i < count; ++i) {
    victims.push_back(std::make_unique<Victim>(pace, folder / ("run" + std::to_string(i) + ".h5"),
                                               from_seconds(random.uniform(0.0, 3.0))));
  }
  for (int alive = count; alive > 0;) {
    std::this_thread::sleep_for(2ms);
    for (const auto& victim : victims) {
      if (!victim->is_alive) continue;
      victim->history.emplace_back(MonotonicClock::now(), (*victim->told).recorded.load());
      if (MonotonicClock::now() < victim->end) continue;
      const Time killed = MonotonicClock::now();
      kill_at_once(victim->process);
      victim->is_alive = false;
      --alive;
      inspect(*victim, killed);
    }
  }
}

void kill_ends_of_runs(int count, std::uint64_t seed, const std::filesystem::path& folder) {
  RandomGenerator random(seed);
  for (int i = 0; i < count; ++i) {
    const std::filesystem::path file = folder / ("ends" + std::to_string(i) + ".h5");
    const Shared told;
    OtherProgram process([&] { record_over_and_over(file, *told); });
    std::this_thread::sleep_for(from_seconds(random.uniform(0.0, 0.1)));
    kill_at_once(process);
    if ((*told).finished > 0) {
      const Recording recording = open_recording(file);
      EXPECT_EQ(recording.samples(), 300U);
      EXPECT_EQ(recording.attributes.count("recording.partial"), 0U);
      expect_beginning_of_the_run(recording);
    }
    try {
      expect_beginning_of_the_run(open_journal(part_name(file)));
    } catch (const SetupError&) {  // there is none, or its description was not complete: nothing had begun
      EXPECT_TRUE((*told).recorded == 0 || std::filesystem::exists(file));
    }
  }
}

}  // namespace flinch::test
