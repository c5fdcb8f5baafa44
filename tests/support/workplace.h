#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace flinch::test {

/// All bytes of a file; none where there is no file.
std::string bytes_of(const std::filesystem::path& file);

/// A scenario or robot that ships with the project, from the folder apps/.
std::filesystem::path shipped(const std::string& name);

/// The shipped scenarios, by name.
std::vector<std::string> shipped_scenarios();

/// A folder of its own for one test, with the shipped scenarios and robots to spoil; gone after the test.
class Workplace {
 public:
  Workplace();
  ~Workplace();
  Workplace(const Workplace&) = delete;
  Workplace& operator=(const Workplace&) = delete;

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
  std::filesystem::path folder_;
};

}  // namespace flinch::test
