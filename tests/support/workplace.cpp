#include "tests/support/workplace.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <fstream>
#include <iterator>

namespace flinch::test {
namespace {

namespace fs = std::filesystem;

std::string name_of_test() {
  const ::testing::TestInfo& test = *::testing::UnitTest::GetInstance()->current_test_info();
  std::string name = std::string(test.test_suite_name()) + "_" + test.name();
  std::replace(name.begin(), name.end(), '/', '_');
  return name;
}

}  // namespace

std::string bytes_of(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

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
  static std::atomic<int> made = 0;  // a test may have several
  folder_ = fs::path(::testing::TempDir()) /
            ("flinch_" + name_of_test() + "_" + std::to_string(getpid()) + "_" + std::to_string(++made));
  fs::remove_all(folder_);
  fs::create_directories(folder_);
  for (const std::string part : {"scenarios", "robots"}) fs::copy(shipped(part), folder_ / part);
}

Workplace::~Workplace() { fs::remove_all(folder_); }

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
  for (const auto& entry : fs::recursive_directory_iterator(folder_)) {
    files[entry.path().string()] = entry.is_directory() ? "" : bytes_of(entry.path());
  }
  return files;
}

}  // namespace flinch::test
