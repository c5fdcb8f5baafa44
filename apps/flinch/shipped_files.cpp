#include "apps/flinch/shipped_files.h"

namespace flinch {

namespace fs = std::filesystem;

fs::path shipped_folder() {
  std::error_code none;
  const fs::path program = fs::read_symlink("/proc/self/exe", none);
  for (fs::path folder = program.parent_path(); folder.has_relative_path(); folder = folder.parent_path()) {
    for (const char* const below : {"share/flinch", "apps"}) {
      if (fs::is_directory(folder / below / "scenarios", none)) return folder / below;
    }
  }
  return {};
}

fs::path or_shipped(const fs::path& file, const char* kind) {
  std::error_code none;
  const bool is_there = fs::exists(file, none);
  if (file.empty() || file.has_parent_path() || (is_there && !fs::is_directory(file, none))) return file;
  const fs::path folder = shipped_folder();
  if (folder.empty()) return file;
  for (const fs::path& name : {file, fs::path(file.string() + ".yaml")}) {
    if (fs::is_regular_file(folder / kind / name, none)) return folder / kind / name;
  }
  return is_there || file.has_extension() ? file : folder / kind / file;
}

}  // namespace flinch
