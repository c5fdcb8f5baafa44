#pragma once

#include <cstddef>
#include <filesystem>
#include <fstream>
#include <map>
#include <optional>

#include "experiments/dataset/contact_samples.h"

namespace flinch {

struct DataSpec;

/// The samples of a data set while it is made: a file to which each run adds its own as soon as it is done,
/// with a checksum. A program that is killed leaves whole runs and at most one torn one, which is left out;
/// the next call goes on where it stopped.
class DataJournal {
 public:
  /// Opens the journal, or begins one. Throws SetupError where it cannot be read or written, and where it is
  /// that of another data set.
  DataJournal(std::filesystem::path file, const DataSpec& spec, const ParallelRobot& robot);

  /// What is done, by number of the run.
  const std::map<std::size_t, ContactSamples>& runs() const { return runs_; }

  /// The first run that is done and has samples.
  std::optional<std::size_t> first_with_samples() const;

  /// Throws SetupError where the run that is done has other samples than when it is `made` again: another
  /// build of the program has made the journal, or files have changed that the specification does not know.
  void require_same(std::size_t run, const ContactSamples& made) const;

  /// Throws SetupError where the disk does not take it.
  void add(std::size_t run, const ContactSamples& samples);

  void remove();

 private:
  void read(const std::string& header, const ParallelRobot& robot);

  std::filesystem::path file_;
  std::ofstream stream_;
  std::map<std::size_t, ContactSamples> runs_;
};

}  // namespace flinch
