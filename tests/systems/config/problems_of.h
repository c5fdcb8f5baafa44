#pragma once

#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <vector>

#include "systems/config/config_reader.h"
#include "tests/support/problems_of.h"

namespace flinch::test {

using Problems = std::vector<std::string>;

using test::problems_of;

/// What is wrong with `text`, which comes from "a.yaml", for a reader that wants what `read` reads.
inline Problems problems_of(const std::string& text, const std::function<void(ConfigReader&)>& read) {
  return problems_of([&] {
    ConfigReader reader = ConfigReader::parse(text, "a.yaml");
    read(reader);
    reader.finish();
  });
}

/// A folder for one test, gone after it.
class TemporaryFolder {
 public:
  explicit TemporaryFolder(const std::string& name)
      : path_(std::filesystem::temp_directory_path() / ("flinch_" + name)) {
    std::filesystem::remove_all(path_);
    std::filesystem::create_directories(path_);
  }
  ~TemporaryFolder() { std::filesystem::remove_all(path_); }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  std::filesystem::path write(const std::string& name, const std::string& text) const {
    std::ofstream(path_ / name) << text;
    return path_ / name;
  }
  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }

 private:
  std::filesystem::path path_;
};

}  // namespace flinch::test
