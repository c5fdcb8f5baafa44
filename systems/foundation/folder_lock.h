#pragma once

#include <filesystem>
#include <utility>

namespace flinch {

/// Keeps a folder of results for one program while it lives. Ends with the program, whatever ends it, and
/// leaves nothing behind. Where a file system has no locks there is none.
class FolderLock {
 public:
  /// Throws SetupError naming the program that has the folder.
  explicit FolderLock(const std::filesystem::path& folder);
  FolderLock(FolderLock&& other) noexcept : descriptor_(std::exchange(other.descriptor_, -1)) {}
  FolderLock& operator=(FolderLock&& other) noexcept {
    std::swap(descriptor_, other.descriptor_);
    return *this;
  }
  ~FolderLock();

 private:
  int descriptor_ = -1;
};

}  // namespace flinch
