#include "experiments/dataset/data_spec.h"

#include <algorithm>

#include "experiments/campaign/campaign_run.h"
#include "systems/config/config_file.h"
#include "systems/config/config_reader.h"
#include "systems/config/file_kind.h"
#include "systems/config/parsed.h"
#include "systems/foundation/setup_error.h"
#include "systems/foundation/sha256.h"
#include "systems/framework/random.h"

namespace flinch {
namespace {

DataPart read_part(ConfigReader& reader, std::vector<CalibrationWarning>& warnings) {
  DataPart part;
  std::filesystem::path campaign;
  reader.required().file("campaign", campaign);
  reader.integer("share", part.share, 1, 1000);
  reader.text("configuration", part.configuration);
  if (campaign.empty()) return part;
  try {
    part.campaign = read_campaign(campaign);
    for (const CalibrationWarning& warning : check_keys(part.campaign)) {
      if (std::find(warnings.begin(), warnings.end(), warning) == warnings.end()) warnings.push_back(warning);
    }
  } catch (const SetupError& error) {
    reader.add_problems(error.problems());
    return part;
  }
  const auto& grid = part.campaign.grid;
  const bool is_axis = std::any_of(grid.begin(), grid.end(),
                                   [&](const CampaignAxis& axis) { return axis.key == part.configuration; });
  if (!part.configuration.empty() && !is_axis) {
    reader.problem("configuration",
                   "is '" + part.configuration + "', which is no axis of the campaign's grid");
  }
  return part;
}

void read_contacts(ConfigReader& reader, DataRecording& recording) {
  for (ConfigReader& entry : reader.sections("contacts")) {
    MarkedContact contact;
    entry.required().number("at", unit::s, contact.at, not_negative);
    contact.touched = recording.touched;
    (recording.touched.empty() ? entry.required() : entry).text("touched", contact.touched);
    if (!recording.contacts.empty() && contact.at <= recording.contacts.back().at)
      entry.problem("at_s", "is not after that of the contact before it; name them in their order");
    recording.contacts.push_back(std::move(contact));
  }
}

DataRecording read_recording_entry(ConfigReader& reader) {
  DataRecording recording;
  reader.required().file("file", recording.file);
  reader.file("scenario", recording.scenario);
  reader.text("touched", recording.touched);
  read_contacts(reader, recording);
  if (!recording.scenario.empty()) recording.scenario_text = read_config_file(recording.scenario);
  reader.integer("configuration", recording.configuration, 0, 1'000'000);
  recording.sha256 = sha256_of(recording.file);
  return recording;
}

void read_samples(ConfigReader reader, SampleChoice& samples) {
  reader.text("wrench", samples.wrench);
  reader.text("early_by", samples.early_by);
  reader.integer("every", samples.every, 1, 1000);
  reader.number("from_force", unit::N, samples.from_force, positive);
}

}  // namespace

std::string DataSpec::identity() const {
  std::string text = "flinch " FLINCH_VERSION "\nseed " + std::to_string(seed) + "\nwrench " +
                     samples.wrench + "\nearly by " + samples.early_by + "\nevery " +
                     std::to_string(samples.every) + "\n";
  if (samples.from_force) text += "from " + exact_text(*samples.from_force) + "\n";
  for (const DataPart& part : parts) {
    text += "part " + std::to_string(part.share) + " " + part.configuration + "\n" + part.campaign.identity();
  }
  for (const DataRecording& recording : recordings) {
    text += "recording " + recording.sha256 + " " + recording.touched + " " +
            std::to_string(recording.configuration) + "\n" + recording.scenario_text;
    for (const MarkedContact& contact : recording.contacts)
      text += "contact " + exact_text(contact.at) + " " + contact.touched + "\n";
  }
  return text;
}

DataSpec read_data_spec(const std::filesystem::path& file, const DataSpecOverrides& overrides) {
  DataSpec spec;
  spec.file = file;
  spec.file_text = read_config_file(file);
  spec.title = file.stem().string();
  ConfigReader reader = ConfigReader::parse(spec.file_text, file.string());
  require_kind(reader, FileKind::data_spec);
  reader.text("title", spec.title);
  reader.text("description", spec.description);
  reader.seed("seed", spec.seed);
  int runs = static_cast<int>(spec.runs);
  reader.integer("runs", runs, 1, 10'000'000);
  spec.runs = overrides.runs.value_or(static_cast<std::size_t>(runs));
  spec.seed = overrides.seed.value_or(spec.seed);
  read_samples(reader.section("samples"), spec.samples);
  for (ConfigReader& part : reader.sections("contacts")) spec.parts.push_back(read_part(part, spec.warnings));
  for (ConfigReader& entry : reader.sections("recordings")) {
    DataRecording recording = read_recording_entry(entry);
    const auto is_same = [&](const DataRecording& other) { return other.sha256 == recording.sha256; };
    if (std::any_of(spec.recordings.begin(), spec.recordings.end(), is_same))
      entry.problem("file", "is the recording of an entry before it; leave one of them out");
    spec.recordings.push_back(std::move(recording));
  }
  if (reader.good() && spec.parts.empty() && spec.recordings.empty()) {
    reader.problem("", "names neither 'contacts' nor 'recordings'; there is nothing to make data of");
  }
  reader.finish();
  for (std::size_t i = 0; i < spec.parts.size(); ++i) {
    Campaign& campaign = spec.parts[i].campaign;
    campaign.seed = derive_seed(spec.seed, "part " + std::to_string(i));
    campaign.draws = 1'000'000;  // as many as are asked for are made
  }
  return spec;
}

}  // namespace flinch
