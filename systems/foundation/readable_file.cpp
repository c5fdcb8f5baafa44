#include "systems/foundation/readable_file.h"

#include <cstdint>
#include <fstream>
#include <system_error>

namespace flinch {
namespace fs = std::filesystem;

std::string problem_with_kind(const fs::file_status& status) {
  if (status.type() == fs::file_type::directory) return "is a folder; it must be a file";
  return status.type() == fs::file_type::regular ? "" : "is no regular file; it must be one";
}

std::string problem_with_name(const fs::path& file) {
  const bool is_cut = file.native().find('\0') != std::string::npos;
  return is_cut ? "has a character 0 in its name, at which the system ends names; leave it out" : "";
}

std::string problem_with_reading(const fs::path& file) {
  if (std::string problem = problem_with_name(file); !problem.empty()) return problem;
  std::error_code error;
  const fs::file_status status = fs::status(file, error);
  if (status.type() == fs::file_type::not_found) return "there is no such file";
  if (error) return "cannot be read: " + error.message();
  if (std::string problem = problem_with_kind(status); !problem.empty()) return problem;
  const std::uintmax_t size = fs::file_size(file, error);
  if (error) return "cannot be read: " + error.message();
  if (size == 0) return "is empty";
  return std::ifstream(file) ? "" : "cannot be opened; reading it must be permitted";
}

}  // namespace flinch
