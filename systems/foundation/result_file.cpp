#include "systems/foundation/result_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cctype>
#include <cerrno>
#include <system_error>
#include <utility>

#include "systems/foundation/readable_file.h"
#include "systems/foundation/setup_error.h"

namespace flinch {
namespace {

namespace fs = std::filesystem;

constexpr const char* unfinished_end = ".new";

fs::path folder_of(const fs::path& file) {
  return file.has_parent_path() ? file.parent_path() : fs::path(".");
}

/// A lock that ends with the program, whatever ends it. Another kind than that of HDF5, which locks the file
/// too.
bool lock(int descriptor) {
  struct flock whole {};
  whole.l_type = F_WRLCK;
  whole.l_whence = SEEK_SET;
  return ::fcntl(descriptor, F_OFD_SETLK, &whole) == 0;
}

bool has_name(int descriptor) {
  struct stat status {};
  return ::fstat(descriptor, &status) == 0 && status.st_nlink > 0;
}

/// "run.h5.1234-1.new"
bool is_unfinished_name(const std::string& name, const std::string& of_file) {
  const std::string end = unfinished_end;
  if (!name.starts_with(of_file + ".") || !name.ends_with(end)) return false;
  if (name.size() <= of_file.size() + 1 + end.size()) return false;
  return std::all_of(name.begin() + static_cast<std::ptrdiff_t>(of_file.size()) + 1,
                     name.end() - static_cast<std::ptrdiff_t>(end.size()),
                     [](unsigned char letter) { return std::isdigit(letter) != 0 || letter == '-'; });
}

void remove_leftovers(const fs::path& file) {
  std::error_code error;
  for (fs::directory_iterator entry(folder_of(file), error), end; !error && entry != end;
       entry.increment(error)) {
    if (!is_unfinished_name(entry->path().filename().string(), file.filename().string())) continue;
    const int left = ::open(entry->path().c_str(), O_RDWR | O_NOFOLLOW | O_CLOEXEC | O_NONBLOCK);
    if (left >= 0 && lock(left)) ::unlink(entry->path().c_str());  // nobody writes it
    if (left >= 0) ::close(left);
  }
}

/// Opens a new file and locks it. Where another program took it for a leftover in between, its name is gone.
int open_new(const fs::path& name) {
  for (;;) {
    const int descriptor = ::open(name.c_str(), O_RDWR | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666);
    if (descriptor < 0) return -1;
    lock(descriptor);
    if (has_name(descriptor)) return descriptor;
    ::close(descriptor);
  }
}

/// Neither a file nor nothing: what is written there is gone at once.
bool is_device(const fs::path& file) {
  std::error_code error;
  const fs::file_type type = fs::status(file, error).type();
  return type == fs::file_type::character || type == fs::file_type::fifo || type == fs::file_type::socket;
}

}  // namespace

ResultFile::ResultFile(fs::path file) : file_(std::move(file)) {
  if (const std::string problem = problem_with_name(file_); !problem.empty())
    throw SetupError(file_.string() + ": " + problem);
  std::error_code error;
  if (is_device(file_)) {
    descriptor_ = ::open(file_.c_str(), O_WRONLY | O_CLOEXEC);
  } else if (fs::is_directory(file_, error)) {
    errno = EISDIR;
  } else {
    static std::atomic<int> count = 0;
    remove_leftovers(file_);
    unfinished_ =
        file_.string() + "." + std::to_string(::getpid()) + "-" + std::to_string(++count) + unfinished_end;
    descriptor_ = open_new(unfinished_);
  }
  if (descriptor_ < 0) fail();
}

ResultFile::~ResultFile() {
  if (descriptor_ < 0) return;
  if (!is_direct()) ::unlink(unfinished_.c_str());
  ::close(descriptor_);
}

void ResultFile::write(std::string_view text) const {
  while (!text.empty()) {
    const ssize_t written = ::write(descriptor_, text.data(), text.size());
    fail_unless(written >= 0 || errno == EINTR);
    text.remove_prefix(static_cast<std::size_t>(std::max<ssize_t>(written, 0)));
  }
}

void ResultFile::reserve(std::size_t bytes) const {
  struct stat status {};
  fail_unless(::fstat(descriptor_, &status) == 0);
  const auto more = static_cast<off_t>(bytes);
  if (::fallocate(descriptor_, FALLOC_FL_KEEP_SIZE, status.st_size, more) == 0) return;
  fail_unless(errno == EOPNOTSUPP || errno == ENOSYS || errno == EINTR);
  struct statvfs system {};
  fail_unless(::fstatvfs(descriptor_, &system) == 0);
  if (system.f_bavail * system.f_frsize >= bytes) return;
  errno = ENOSPC;
  fail();
}

void ResultFile::finish() {
  if (!is_direct()) {
    struct stat status {};
    fail_unless(::fstat(descriptor_, &status) == 0 &&
                ::ftruncate(descriptor_, status.st_size) == 0);  // what is reserved
    fail_unless(::fsync(descriptor_) == 0);
    fail_unless(::rename(unfinished_.c_str(), file_.c_str()) == 0);
  }
  const int descriptor = std::exchange(descriptor_, -1);
  fail_unless(::close(descriptor) == 0);
  const int folder = ::open(folder_of(file_).c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (folder < 0) return;  // it may be written but not read
  ::fsync(folder);         // where a file system has no such thing there is nothing to wait for
  ::close(folder);
}

void ResultFile::fail() const {
  throw SetupError(file_.string() +
                   ": the file cannot be written: " + std::generic_category().message(errno));
}

void remove_link(const fs::path& file) {
  std::error_code ignored;
  if (fs::is_symlink(file, ignored)) fs::remove(file, ignored);
}

void remove_unfinished(const fs::path& file) {
  std::error_code ignored;
  if (fs::is_regular_file(fs::symlink_status(file, ignored))) fs::remove(file, ignored);
}

void require_place(const fs::path& file, const std::vector<fs::path>& inputs) {
  if (file.empty()) return;
  std::error_code error;
  for (const fs::path& input : inputs) {
    if (fs::equivalent(file, input, error))
      throw SetupError(file.string() + ": is read by this call, which would replace it; choose another name");
  }
  if (!fs::is_directory(folder_of(file), error)) {
    throw SetupError(file.string() + ": cannot be written, for there is no folder " +
                     folder_of(file).string() + "; make it first");
  }
  const ResultFile tried(file);
}

void write_result(const fs::path& file, std::string_view text) {
  ResultFile result(file);
  result.write(text);
  result.finish();
}

}  // namespace flinch
