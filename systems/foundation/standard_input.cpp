#include "systems/foundation/standard_input.h"

#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <string>
#include <system_error>

#include "systems/foundation/setup_error.h"

namespace flinch {
namespace {

namespace fs = std::filesystem;

/// Where standard input is kept; empty until it was asked for.
fs::path kept;

/// A folder of this program's own.
class OwnFolder {
 public:
  OwnFolder() {
    std::string name = (fs::temp_directory_path() / "flinch-XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr)
      throw SetupError("standard input: " + name + " cannot be made: " + std::strerror(errno));
    path_ = name;
  }
  OwnFolder(const OwnFolder&) = delete;
  OwnFolder& operator=(const OwnFolder&) = delete;
  ~OwnFolder() {
    std::error_code none;
    fs::remove_all(path_, none);
  }

  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

void copy_standard_input(const fs::path& file) {
  std::ofstream out(file, std::ios::binary);
  std::array<char, 1 << 16> piece{};
  for (ssize_t got = 1; got > 0 && out;) {
    got = ::read(STDIN_FILENO, piece.data(), piece.size());
    if (got < 0 && errno == EINTR) {
      got = 1;
      continue;
    }
    if (got < 0) throw SetupError(std::string("standard input: cannot be read: ") + std::strerror(errno));
    out.write(piece.data(), got);
  }
  if (!out.flush()) throw SetupError("standard input: " + file.string() + " has no room for it");
}

}  // namespace

const fs::path& standard_input_file() {
  static const OwnFolder folder;
  if (kept.empty()) {
    const fs::path file = folder.path() / "standard_input";
    copy_standard_input(file);
    kept = file;
  }
  return kept;
}

fs::path folder_named_in(const fs::path& file) {
  return !kept.empty() && file == kept ? fs::path() : file.parent_path();
}

}  // namespace flinch
