#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "experiments/campaign/campaign.h"
#include "experiments/scenario/calibration_warnings.h"

namespace flinch {

/// Which ticks of a run become samples.
struct SampleChoice {
  /// Whose estimate is kept: "isolation", which classifiers read, or the name of an estimator.
  std::string wrench = "isolation";
  /// Whose detector tells the early tick: the name of an estimator that is not followed; "": none does.
  std::string early_by;
  int every = 5;  ///< of the ticks between the first moment and the last, one in so many ms; moments always
  /// Instead of those: all ticks of a contact at which a force is estimated that reaches this [N].
  std::optional<double> from_force;
};

/// Contacts from a campaign.
struct DataPart {
  Campaign campaign;
  int share = 1;              ///< of the runs, against that of the others
  std::string configuration;  ///< axis of the grid whose values are configurations; "": each run is one
};

/// A contact that somebody has marked in a recording.
struct MarkedContact {
  double at = 0.0;      ///< begins [s]
  std::string touched;  ///< name of the class
};

/// Contacts from a recording of a robot, real or simulated.
struct DataRecording {
  std::filesystem::path file;
  std::string sha256;  ///< of the file
  /// Of a log: whose control path runs over it; empty: that of the log.
  std::filesystem::path scenario{};
  std::string scenario_text{};
  std::string touched;  ///< name of the class of all contacts; "": each has one, or the recording's truth has
  std::vector<MarkedContact> contacts{};  ///< in their order; empty: the first, or what a force sensor tells
  int configuration = 0;
};

/// What a data set is made of. docs/files.md has the keys of the file.
struct DataSpec {
  std::filesystem::path file;
  std::string file_text;  ///< of that file
  std::string title, description;
  std::uint64_t seed = 1;
  std::size_t runs = 1000;  ///< of all parts together
  SampleChoice samples;
  std::vector<DataPart> parts;
  std::vector<DataRecording> recordings;
  std::vector<CalibrationWarning> warnings;  ///< about those of the campaigns

  /// Everything that decides about the data but the number of runs, in words.
  std::string identity() const;
};

struct DataSpecOverrides {
  std::optional<std::size_t> runs = std::nullopt;
  std::optional<std::uint64_t> seed = std::nullopt;
};

/// Throws SetupError with all that is wrong with the file and with the campaigns that it names.
DataSpec read_data_spec(const std::filesystem::path& file, const DataSpecOverrides& overrides = {});

}  // namespace flinch
