#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "tests/support/file_bytes.h"
#include "tests/support/temporary_folder.h"

namespace flinch::test {

/// A scenario or robot that ships with the project, from the folder apps/.
std::filesystem::path shipped(const std::string& name);

/// The shipped scenarios, by name.
std::vector<std::string> shipped_scenarios();

/// A folder of its own for one test, with the shipped scenarios, robots and calibrations to spoil; gone after
/// the test.
class Workplace {
 public:
  Workplace();

  std::filesystem::path operator/(const std::string& name) const { return folder_ / name; }
  /// `name` in it, as an argument.
  std::string at(const std::string& name) const { return (folder_ / name).string(); }

  void write(const std::string& name, const std::string& text) const;
  /// Replaces the first `from` in a file; there must be one.
  void replace(const std::string& name, const std::string& from, const std::string& to) const;
  /// Number of the first line of a file with `text`.
  int line_of(const std::string& name, const std::string& text) const;

  /// Every file with its bytes.
  std::map<std::string, std::string> contents() const;

 private:
  TemporaryFolder folder_;
};

}  // namespace flinch::test
