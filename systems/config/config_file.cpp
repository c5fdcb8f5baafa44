#include "systems/config/config_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstddef>
#include <fstream>
#include <system_error>
#include <vector>

#include "systems/foundation/nearest_name.h"
#include "systems/foundation/readable_file.h"
#include "systems/foundation/setup_error.h"

namespace flinch {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t most_bytes = 1'000'000;

std::vector<std::string> yaml_files_in(const fs::path& folder) {
  std::error_code error;
  std::vector<std::string> names;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    const fs::path extension = entry->path().extension();
    if (extension == ".yaml" || extension == ".yml") names.push_back(entry->path().filename().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

// "; did you mean 'planar_3rrr.yaml'?", endings left out of the comparison; otherwise all files that are
// there.
std::string similar_files(const fs::path& file, const std::vector<std::string>& present) {
  std::vector<std::string> stems;
  for (const std::string& name : present) stems.push_back(fs::path(name).stem().string());
  const auto nearest = std::find(stems.begin(), stems.end(), nearest_name(file.stem().string(), stems));
  if (nearest != stems.end()) {
    return "; did you mean '" + present[static_cast<std::size_t>(nearest - stems.begin())] + "'?";
  }
  return present.empty() ? "" : "; its folder has " + listed(present);
}

std::string missing(const fs::path& file) {
  const fs::path folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
  std::error_code error;
  if (!fs::is_directory(folder, error)) return "no such file, for there is no folder " + folder.string();
  return "no such file" + similar_files(file, yaml_files_in(folder));
}

}  // namespace

std::string problem_with_file(const fs::path& file) {
  if (file.empty()) return "the name is empty; it must be the name of a file";
  if (std::string problem = problem_with_name(file); !problem.empty()) return problem;
  std::error_code error;
  const fs::file_status status = fs::status(file, error);
  if (status.type() == fs::file_type::not_found) return missing(file);
  if (error) return "cannot be read: " + error.message();
  if (std::string problem = problem_with_kind(status); !problem.empty()) return problem;
  if (!std::ifstream(file)) return "cannot be opened; reading it must be permitted";
  return "";
}

std::string read_config_file(const fs::path& file) {
  const std::string problem = problem_with_file(file);
  if (!problem.empty()) throw SetupError(file.string() + ": " + problem);
  // Some files of the system have no size, no end, or keep who reads them waiting.
  const int descriptor = ::open(file.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
  std::string text;
  std::array<char, 1 << 15> piece{};
  ssize_t got = descriptor < 0 ? -1 : 1;
  while (got > 0 && text.size() <= most_bytes) {
    got = ::read(descriptor, piece.data(), piece.size());
    text.append(piece.data(), static_cast<std::size_t>(std::max<ssize_t>(got, 0)));
  }
  const int reason = errno;
  if (descriptor >= 0) ::close(descriptor);
  if (got < 0)
    throw SetupError(file.string() + ": cannot be read: " + std::generic_category().message(reason));
  if (text.starts_with("\x89HDF"))
    throw SetupError(file.string() + ": is an HDF5 file, such as a recording; it must be YAML");
  if (text.find('\0') != std::string::npos) throw SetupError(file.string() + ": is no text; it must be YAML");
  if (text.size() > most_bytes) {
    throw SetupError(file.string() + ": has more than " + std::to_string(most_bytes) +
                     " bytes; a file of settings has fewer");
  }
  return text;
}

}  // namespace flinch
