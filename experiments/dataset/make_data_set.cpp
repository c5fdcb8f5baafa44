#include "experiments/dataset/make_data_set.h"

#include <fmt/core.h>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <numeric>
#include <thread>

#include "experiments/campaign/campaign_run.h"
#include "experiments/dataset/contact_samples.h"
#include "experiments/dataset/data_journal.h"
#include "experiments/dataset/data_spec.h"
#include "experiments/simulated/experiment.h"
#include "systems/foundation/problems_of_place.h"
#include "systems/foundation/setup_error.h"
#include "systems/foundation/sha256.h"
#include "systems/framework/recording.h"

namespace flinch {
namespace {

/// Where run `number` of the specification stands: in which part, and as which of its runs.
struct Turn {
  std::size_t part = 0;
  std::size_t run = 0;
};

/// Parts take turns, each as often as its share says.
Turn turn_of(const DataSpec& spec, std::size_t number) {
  std::size_t turns = 0;
  for (const DataPart& part : spec.parts) turns += static_cast<std::size_t>(part.share);
  std::size_t left = number % turns, part = 0;
  while (left >= static_cast<std::size_t>(spec.parts[part].share)) {
    left -= static_cast<std::size_t>(spec.parts[part].share);
    ++part;
  }
  return {part, number / turns * static_cast<std::size_t>(spec.parts[part].share) + left};
}

/// Which value of the axis a run has; each run its own without an axis.
int configuration_of(const DataPart& part, const CampaignRun& run, std::size_t number) {
  if (part.configuration.empty()) return static_cast<int>(number);
  std::size_t digits = run.point / part.campaign.scenarios.size();
  for (const CampaignAxis& axis : part.campaign.grid) {
    if (axis.key == part.configuration) return static_cast<int>(digits % axis.values.size());
    digits /= axis.values.size();
  }
  return 0;
}

/// Simulates the runs that the journal has not, on many threads.
class Workers {
 public:
  Workers(const DataSpec& spec, DataJournal& journal) : spec_(spec), journal_(journal) {}

  void run(std::size_t threads, const DataProgress& progress) {
    std::vector<std::jthread> workers;
    running_ = threads;
    for (std::size_t i = 0; i < threads; ++i) workers.emplace_back([this] { work(); });
    std::unique_lock lock(mutex_);
    while (running_ > 0) {
      changed_.wait_for(lock, std::chrono::milliseconds(100));
      const std::size_t done = journal_.runs().size();
      if (progress && !progress(std::min(done, spec_.runs))) ended_ = true;
    }
    lock.unlock();
    workers.clear();
    if (problem_) std::rethrow_exception(problem_);
    if (ended_) {
      throw SetupError(fmt::format("stopped after {} of {} runs; the same call goes on from there",
                                   journal_.runs().size(), spec_.runs));
    }
  }

 private:
  std::optional<std::size_t> next() {
    const std::lock_guard lock(mutex_);
    while (next_ < spec_.runs && journal_.runs().contains(next_)) ++next_;
    if (ended_ || next_ >= spec_.runs) return std::nullopt;
    return next_++;
  }

  void work() {
    try {
      while (const auto number = next()) {
        const ContactSamples samples = simulate_contact(spec_, *number);
        const std::lock_guard lock(mutex_);
        journal_.add(*number, samples);
      }
    } catch (...) {
      const std::lock_guard lock(mutex_);
      if (!problem_) problem_ = std::current_exception();
      ended_ = true;
    }
    const std::lock_guard lock(mutex_);
    --running_;
    changed_.notify_one();
  }

  const DataSpec& spec_;
  DataJournal& journal_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::size_t next_ = 0, running_ = 0;
  bool ended_ = false;
  std::exception_ptr problem_;
};

/// The robot of all parts and recordings, without samples.
DataSet without_samples(const DataSpec& spec) {
  DataSet data;
  const auto take = [&data](const Scenario& scenario, const std::string& where) {
    if (!data.robot) {
      data.robot = scenario.robot.robot;
      data.robot_file = scenario.robot_file.filename().string();
      data.robot_text = scenario.robot_text;
    } else if (fingerprint(data.robot_text, data.robot_file) !=
               fingerprint(scenario.robot_text, scenario.robot_file.string())) {
      throw SetupError(where + ": is of another robot than what stands before it; a data set is of one");
    }
  };
  for (const DataPart& part : spec.parts) {
    for (const std::filesystem::path& scenario : part.campaign.scenarios)
      take(read_scenario(scenario), part.campaign.file.string());
  }
  for (const DataRecording& recording : spec.recordings)
    take(recorded_scenario(open_recording(recording.file), recording.file), recording.file.string());
  return data;
}

int class_named(const std::string& name, const ParallelRobot& robot) {
  const ContactClasses classes = classes_of(robot);
  std::vector<std::string> names;
  for (int number = 0; number < classes.count(); ++number) {
    names.push_back(classes.name(number));
    if (names.back() == name) return number;
  }
  std::string known;
  for (const std::string& each : names) known += (known.empty() ? "" : ", ") + each;
  throw SetupError("'" + name + "' is nothing that can be touched; there are " + known);
}

void add_recordings(const DataSpec& spec, DataSet& data) {
  int run = static_cast<int>(spec.parts.empty() ? 0 : spec.runs);
  for (const DataRecording& recorded : spec.recordings) {
    out_of(recorded.file.string(), [&] {
      const Recording recording = open_recording(recorded.file);
      std::optional<int> touched;
      if (!recorded.touched.empty()) touched = class_named(recorded.touched, *data.robot);
      ContactSamples samples = contact_samples(recording, *data.robot, spec.samples, touched);
      if (samples.samples.empty()) throw SetupError("has no contact to learn from: " + samples.left_out);
      for (DataSample& sample : samples.samples) {
        sample.run = run;
        sample.configuration = recorded.configuration;
        data.samples.push_back(sample);
      }
      return 0;
    });
    ++run;
  }
}

/// The files that decide about the data, as they were read before the first run.
void add_sources(const DataSpec& spec, DataSet& data) {
  const auto add = [&data](const std::string& name, const std::filesystem::path& file,
                           const std::string& text) {
    data.card[name + ".file"] = file.filename().string();
    data.card[name + ".text"] = text;
  };
  data.card["identity"] = sha256(spec.identity());
  add("spec", spec.file, spec.file_text);
  for (std::size_t i = 0; i < spec.parts.size(); ++i) {
    const Campaign& campaign = spec.parts[i].campaign;
    const std::string name = fmt::format("campaign.{}", i + 1);
    add(name, campaign.file, campaign.file_text);
    for (std::size_t k = 0; k < campaign.scenarios.size(); ++k)
      add(fmt::format("{}.scenario.{}", name, k + 1), campaign.scenarios[k], campaign.scenario_texts[k]);
  }
  for (std::size_t i = 0; i < spec.recordings.size(); ++i) {
    const std::string name = fmt::format("recording.{}", i + 1);
    data.card[name + ".file"] = spec.recordings[i].file.filename().string();
    data.card[name + ".sha256"] = spec.recordings[i].sha256;
  }
}

void add_card(const DataSpec& spec, const std::map<std::string, std::size_t>& left_out, DataSet& data) {
  data.card["title"] = spec.title;
  data.card["description"] = spec.description;
  add_sources(spec, data);
  if (!spec.parts.empty()) {  // of what is simulated
    data.card["seed"] = std::to_string(spec.seed);
    data.card["runs"] = std::to_string(spec.runs);
  }
  data.card["flinch.version"] = FLINCH_VERSION;
  data.card["wrench"] = spec.samples.wrench;
  data.card["counts"] = counts_table(data);
  data.card["samples"] = spec.samples.from_force ? "all" : "decisions";
  std::string reasons;
  for (const auto& [reason, count] : left_out) reasons += fmt::format("{}: {}\n", reason, count);
  data.card["left_out"] = reasons;
}

}  // namespace

CampaignRun draw_contact(const DataSpec& spec, std::size_t number) {
  const Turn turn = turn_of(spec, number);
  const Campaign& campaign = spec.parts[turn.part].campaign;
  const std::size_t points = campaign.grid_points();
  return draw_run(campaign, turn.run % points * campaign.draws + turn.run / points);
}

ContactSamples simulate_contact(const DataSpec& spec, std::size_t number) {
  const CampaignRun run = draw_contact(spec, number);
  const Recording recording = run_for_signals(run.scenario, sampled_signals(spec.samples));
  ContactSamples samples = out_of(run.scenario.file.string(), [&] {
    return contact_samples(recording, *run.scenario.robot.robot, spec.samples);
  });
  const DataPart& part = spec.parts[turn_of(spec, number).part];
  for (DataSample& sample : samples.samples) {
    sample.run = static_cast<int>(number);
    sample.configuration = configuration_of(part, run, number);
  }
  return samples;
}

DataSet make_data_set(const DataSpec& spec, const std::filesystem::path& file, std::size_t threads,
                      const DataProgress& progress) {
  DataSet data = without_samples(spec);
  DataJournal journal(file.string() + ".part", spec, *data.robot);
  if (const auto done = journal.first_with_samples())
    journal.require_same(*done, simulate_contact(spec, *done));
  if (threads == 0) threads = std::max(1U, std::thread::hardware_concurrency());
  if (!spec.parts.empty()) Workers(spec, journal).run(threads, progress);
  std::map<std::string, std::size_t> left_out;
  for (const auto& [number, run] : journal.runs()) {
    if (number >= spec.runs) break;
    if (!run.left_out.empty()) ++left_out[run.left_out];
    data.samples.insert(data.samples.end(), run.samples.begin(), run.samples.end());
  }
  add_recordings(spec, data);
  add_card(spec, left_out, data);
  write_data_set(data, file);
  journal.remove();
  return data;
}

}  // namespace flinch
