#include "experiments/dataset/make_data_set.h"

#include <fmt/core.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <memory>
#include <mutex>
#include <numeric>
#include <thread>

#include "experiments/campaign/campaign_run.h"
#include "experiments/dataset/contact_samples.h"
#include "experiments/dataset/data_journal.h"
#include "experiments/dataset/data_spec.h"
#include "experiments/recorded/judged_log.h"
#include "experiments/recorded/measured_contacts.h"
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

/// Whose robot and control path a recording is judged by.
Scenario scenario_of(const DataRecording& recorded, const Recording& recording) {
  return recorded.scenario.empty() ? recorded_scenario(recording, recorded.file)
                                   : read_scenario(recorded.scenario);
}

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
    take(scenario_of(recording, open_recording(recording.file)), recording.file.string());
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

/// What is known of the contacts of a recording; none: its own truth tells.
std::vector<GivenContact> given_contacts(const DataRecording& recorded, const Recording& recording,
                                         const ParallelRobot& robot) {
  std::vector<GivenContact> given;
  for (const MarkedContact& contact : recorded.contacts)
    given.push_back({class_named(contact.touched, robot), contact.at, {}});
  if (given.empty() && !recorded.touched.empty()) {
    const int touched = class_named(recorded.touched, robot);
    if (!holds_readings_alone(recording)) return {{touched, {}, {}}};
    for (const double at : measured_contacts(recording, std::nullopt, {}).contacts)
      given.push_back({touched, at, {}});
    if (given.empty()) throw SetupError("its force sensor shows no contact; give 'contacts'");
  }
  for (std::size_t i = 0; i + 1 < given.size(); ++i) given[i].next = given[i + 1].begin;
  return given;
}

/// A run as it was recorded, or what the control path of a scenario makes of a log.
std::shared_ptr<const Recording> signals_in(const DataSpec& spec, const DataRecording& recorded,
                                            const std::shared_ptr<const Recording>& recording) {
  if (!holds_readings_alone(*recording)) {
    if (!recorded.scenario.empty())
      throw SetupError("holds a run with its scenario; 'scenario' is for logs, leave it out");
    return recording;
  }
  if (recorded.touched.empty() && recorded.contacts.empty())
    throw SetupError(
        "is a log, which does not say what was touched; give 'contacts' with 'at_s' and 'touched' of each, "
        "or 'touched' alone where its force sensor tells when");
  const Scenario scenario = scenario_of(recorded, *recording);
  const std::vector<std::string> wanted = sampled_signals(spec.samples);
  const auto is_wanted = [&wanted](const std::string& path) {
    return std::find(wanted.begin(), wanted.end(), path) != wanted.end();
  };
  return std::make_shared<const Recording>(signals_of_log(scenario, recording, is_wanted));
}

/// Of each contact that somebody knows, or of the first. Runs are counted from `run` on.
std::vector<DataSample> samples_of(const DataSpec& spec, const DataRecording& recorded,
                                   const ParallelRobot& robot, int& run,
                                   std::map<std::string, std::size_t>& left_out) {
  const auto opened = std::make_shared<const Recording>(open_recording(recorded.file));
  const std::vector<GivenContact> known = given_contacts(recorded, *opened, robot);
  const std::shared_ptr<const Recording> recording = signals_in(spec, recorded, opened);
  std::vector<std::optional<GivenContact>> contacts(known.begin(), known.end());
  if (contacts.empty()) contacts.emplace_back();  // the first
  std::vector<DataSample> all;
  std::map<std::string, std::size_t> without;
  for (const std::optional<GivenContact>& given : contacts) {
    const ContactSamples made = contact_samples(*recording, robot, spec.samples, given);
    if (made.samples.empty()) ++without[made.left_out];
    for (DataSample sample : made.samples) {
      sample.run = run;
      sample.configuration = recorded.configuration;
      all.push_back(sample);
    }
    ++run;
  }
  if (all.empty()) throw SetupError("has no contact to learn from: " + without.begin()->first);
  for (const auto& [reason, count] : without) left_out[reason] += count;
  return all;
}

std::vector<DataSample> recorded_samples(const DataSpec& spec, const ParallelRobot& robot,
                                         std::map<std::string, std::size_t>& left_out) {
  std::vector<DataSample> all;
  int run = static_cast<int>(spec.parts.empty() ? 0 : spec.runs);
  for (const DataRecording& recorded : spec.recordings) {
    const std::vector<DataSample> samples =
        out_of(recorded.file.string(), [&] { return samples_of(spec, recorded, robot, run, left_out); });
    all.insert(all.end(), samples.begin(), samples.end());
  }
  return all;
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
    if (!spec.recordings[i].scenario.empty())
      add(name + ".scenario", spec.recordings[i].scenario, spec.recordings[i].scenario_text);
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
  std::map<std::string, std::size_t> left_out;
  // What is wrong with recordings is told before an hour is simulated.
  const std::vector<DataSample> recorded = recorded_samples(spec, *data.robot, left_out);
  DataJournal journal(file.string() + ".part", spec, *data.robot);
  if (const auto done = journal.first_with_samples())
    journal.require_same(*done, simulate_contact(spec, *done));
  if (threads == 0) threads = std::max(1U, std::thread::hardware_concurrency());
  if (!spec.parts.empty()) Workers(spec, journal).run(threads, progress);
  for (const auto& [number, run] : journal.runs()) {
    if (number >= spec.runs) break;
    if (!run.left_out.empty()) ++left_out[run.left_out];
    data.samples.insert(data.samples.end(), run.samples.begin(), run.samples.end());
  }
  data.samples.insert(data.samples.end(), recorded.begin(), recorded.end());
  add_card(spec, left_out, data);
  write_data_set(data, file);
  journal.remove();
  return data;
}

}  // namespace flinch
