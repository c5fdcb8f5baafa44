#include "tests/support/workplace.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

namespace flinch::test {

namespace fs = std::filesystem;

fs::path shipped(const std::string& name) { return fs::path(FLINCH_SOURCE_DIR) / "apps" / name; }

std::vector<std::string> shipped_scenarios() {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(shipped("scenarios"))) {
    if (entry.path().extension() == ".yaml") names.push_back(entry.path().stem().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

Workplace::Workplace() {
  for (const std::string part : {"scenarios", "robots", "calibrations"})
    fs::copy(shipped(part), folder_ / part);
}

void Workplace::write(const std::string& name, const std::string& text) const {
  fs::create_directories((folder_ / name).parent_path());
  std::ofstream(folder_ / name, std::ios::binary) << text;
}

void Workplace::replace(const std::string& name, const std::string& from, const std::string& to) const {
  std::string text = bytes_of(folder_ / name);
  const std::size_t place = text.find(from);
  ASSERT_NE(place, std::string::npos) << name << " has no '" << from << "'";
  write(name, text.replace(place, from.size(), to));
}

int Workplace::line_of(const std::string& name, const std::string& text) const {
  const std::string all = bytes_of(folder_ / name);
  const std::size_t place = std::min(all.find(text), all.size());
  return 1 +
         static_cast<int>(std::count(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(place), '\n'));
}

std::map<std::string, std::string> Workplace::contents() const {
  std::map<std::string, std::string> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder_.path())) {
    files[entry.path().string()] = entry.is_directory() ? "" : bytes_of(entry.path());
  }
  return files;
}

}  // namespace flinch::test
