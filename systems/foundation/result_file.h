#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace flinch {

/// A file of results while it is written: under a name of its own beside the one that it is to have, which an
/// older file keeps until the new one is whole and on the disk. So neither a full disk, a kill nor a second
/// program leaves a file in part, or an older one lost. What dead programs have left of theirs is removed. A
/// symbolic link is replaced, not followed; a device or pipe, as /dev/stdout, is written as it is.
///
/// All throw SetupError naming the file and the reason.
class ResultFile {
 public:
  /// Opens it, so that what cannot be written is known before it is computed.
  explicit ResultFile(std::filesystem::path file);
  ResultFile(const ResultFile&) = delete;
  ResultFile& operator=(const ResultFile&) = delete;
  /// Without finish() nothing is left of it.
  ~ResultFile();

  /// Where it is until then, for libraries that open files by their names.
  const std::filesystem::path& unfinished_name() const { return unfinished_; }

  void write(std::string_view text) const;

  /// Has the file system set aside `bytes` beyond what is written so far, where it can: what does not fit
  /// fails here, and not in the middle of a library.
  void reserve(std::size_t bytes) const;

  /// Sees to it that all is on the disk, and gives the file its name.
  void finish();

 private:
  [[noreturn]] void fail() const;
  void fail_unless(bool good) const {
    if (!good) fail();
  }
  bool is_direct() const { return unfinished_.empty(); }

  std::filesystem::path file_;
  std::filesystem::path unfinished_;  ///< empty for a device
  int descriptor_ = -1;
};

/// Removes a symbolic link where somebody is to write a file by its name: it is replaced, not followed.
void remove_link(const std::filesystem::path& file);

/// Removes what was written of a file that is not to stay. A device or pipe of that name is somebody else's.
void remove_unfinished(const std::filesystem::path& file);

/// Throws SetupError where no result can be written to `file`, or where it would replace one of `inputs`, so
/// that this is known before anything is computed. An empty name stands for no result; nothing is wrong then.
void require_place(const std::filesystem::path& file, const std::vector<std::filesystem::path>& inputs);

/// Writes a whole file so.
void write_result(const std::filesystem::path& file, std::string_view text);

}  // namespace flinch
