#include "tests/fuzz/fuzz_files.h"
#include "tests/support/file_bytes.h"

#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <set>

namespace flinch::test {
namespace {

namespace fs = std::filesystem;

struct Folder {
  Folder() {
    const fs::path memory = "/dev/shm";
    path = (fs::is_directory(memory) ? memory : fs::temp_directory_path()) /
           ("flinch_fuzz_" + std::to_string(::getpid()));
    fs::create_directories(path);
  }
  ~Folder() {
    std::error_code ignored;
    fs::remove_all(path, ignored);
  }
  fs::path path;
};

}  // namespace

const fs::path& fuzz_folder() {
  static const Folder folder;
  return folder.path;
}

fs::path fuzz_file(const std::string& name, std::string_view bytes) {
  const fs::path file = fuzz_folder() / name;
  std::ofstream(file, std::ios::binary | std::ios::trunc)
      .write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  return file;
}

std::vector<std::string> shipped_files(const std::string& folder, const std::string& extension) {
  const fs::path apps = fs::path(FLINCH_SOURCE_DIR) / "apps";
  std::set<fs::path> files;
  for (const auto& entry : fs::directory_iterator(apps / folder)) {
    if (entry.path().extension() == extension) files.insert(entry.path());
  }
  std::vector<std::string> texts;
  for (const fs::path& file : files) {
    std::string text = bytes_of(file);
    const std::string up = "../", whole = apps.string() + "/";
    for (std::size_t at = 0; (at = text.find(up, at)) != std::string::npos; at += whole.size())
      text.replace(at, up.size(), whole);
    texts.push_back(std::move(text));
  }
  return texts;
}

}  // namespace flinch::test
