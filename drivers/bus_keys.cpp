#include "drivers/bus_keys.h"

#include <fcntl.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <string_view>

#include "drivers/bus_security.h"
#include "drivers/key_authority.h"
#include "systems/foundation/setup_error.h"

namespace flinch {
namespace {

namespace fs = std::filesystem;

constexpr std::time_t day = 86400;  // [s]

std::vector<std::string> problems(const BusKeySettings& settings) {
  std::vector<std::string> found;
  if (settings.days < 1 || settings.days > 36500) found.push_back("keys are good for 1 to 36500 days");
  if (settings.domains.last > 230 || settings.domains.first > settings.domains.last) {
    found.push_back("the domains of the bus are 0 to 230");
  }
  return found;
}

[[noreturn]] void fail(const fs::path& path, const std::string& what) {
  throw SetupError(path.string() + ": " + what + ": " + std::strerror(errno));
}

void make_folder(const fs::path& path) {
  if (::mkdir(path.c_str(), 0700) != 0) fail(path, "the folder cannot be made");
}

void write_file(const fs::path& path, std::string_view text, mode_t mode) {
  const int file = ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, mode);
  if (file < 0) fail(path, "the file cannot be made");
  bool good = true;
  while (good && !text.empty()) {
    const ssize_t written = ::write(file, text.data(), text.size());
    good = written > 0;
    if (good) text.remove_prefix(static_cast<std::size_t>(written));
  }
  good = good && ::fsync(file) == 0;
  good = ::close(file) == 0 && good;
  if (!good) fail(path, "the file cannot be written");
}

/// A new folder beside the one wanted, which goes with this unless it has been moved away.
class NewFolder {
 public:
  explicit NewFolder(const fs::path& wanted) : path_(wanted.string() + ".XXXXXX") {
    if (::mkdtemp(path_.data()) == nullptr) fail(wanted, "the folder cannot be made");
  }
  NewFolder(const NewFolder&) = delete;
  NewFolder& operator=(const NewFolder&) = delete;
  ~NewFolder() {
    std::error_code error;
    fs::remove_all(path_, error);
  }
  fs::path path() const { return path_; }

 private:
  std::string path_;
};

bool is_among(const fs::path& path, const std::vector<std::string>& names) {
  return std::find(names.begin(), names.end(), path.filename().string()) != names.end();
}

std::vector<std::string> role_names() {
  std::vector<std::string> names;
  for (const BusRole role : all_bus_roles) names.emplace_back(name(role));
  return names;
}

/// Whether there is nothing in `folder` but what make_bus_keys() makes.
bool has_only_keys(const fs::path& folder) {
  const std::vector<std::string> files(security_file::all.begin(), security_file::all.end());
  for (const auto& role : fs::directory_iterator(folder)) {
    if (!is_among(role.path(), role_names()) || role.is_symlink() || !role.is_directory()) return false;
    for (const auto& file : fs::directory_iterator(role.path())) {
      if (!is_among(file.path(), files)) return false;
    }
  }
  return true;
}

/// Throws SetupError where keys must not be put at `folder`.
void require_place(const fs::path& folder, bool replace) {
  std::error_code error;
  const fs::path parent = folder.parent_path();
  if (!parent.empty() && !fs::is_directory(parent, error)) {
    throw SetupError(folder.string() + ": keys cannot be put here, for there is no folder " +
                     parent.string() + "; make it first");
  }
  const fs::file_status status = fs::symlink_status(folder, error);
  if (!fs::exists(status)) return;
  if (!fs::is_directory(status)) throw SetupError(folder.string() + ": keys need a folder, and this is none");
  if (!has_only_keys(folder)) {
    throw SetupError(folder.string() + ": there are other things than keys in this folder; name another");
  }
  if (!replace && !fs::is_empty(folder)) {
    throw SetupError(
        folder.string() +
        ": there are keys already, and those who have them could no longer talk to those who get "
        "new ones; --force replaces them");
  }
}

void write_role(const fs::path& folder, BusRole role, const KeyAuthority& identity,
                const KeyAuthority& permissions, const KeyValidity& validity, const DomainRange& domains) {
  const Credential own = identity.issue(std::string("flinch ") + name(role));
  make_folder(folder);
  write_file(folder / security_file::private_key, own.private_key, 0600);
  write_file(folder / security_file::certificate, own.certificate, 0644);
  write_file(folder / security_file::identity_authority, identity.certificate(), 0644);
  write_file(folder / security_file::permissions_authority, permissions.certificate(), 0644);
  write_file(folder / security_file::governance, permissions.sign(governance_document(domains)), 0644);
  const std::string document = permissions_document(role, own.subject, validity, domains);
  write_file(folder / security_file::permissions, permissions.sign(document), 0644);
}

/// Puts `made` in the place of `folder`, at one stroke.
void put_in_place(const fs::path& made, const fs::path& folder) {
  const bool replaces = fs::exists(folder) && !fs::is_empty(folder);
  const int result = replaces ? ::renameat2(AT_FDCWD, made.c_str(), AT_FDCWD, folder.c_str(), RENAME_EXCHANGE)
                              : ::rename(made.c_str(), folder.c_str());
  if (result != 0) fail(folder, "the keys cannot be put here");
}

}  // namespace

KeyValidity make_bus_keys(const fs::path& folder, const BusKeySettings& settings) {
  throw_if_any(problems(settings));
  const fs::path place = (folder / "").lexically_normal().parent_path();  // without a slash at the end
  if (place.empty()) throw SetupError("keys need a folder with a name of its own");
  require_place(place, settings.replace);

  const std::time_t now = std::time(nullptr);
  const KeyValidity validity{.from = now - day, .to = now + settings.days * day};
  const KeyAuthority identity("flinch identity authority", validity);
  const KeyAuthority permissions("flinch permissions authority", validity);
  const NewFolder made(place);
  for (const BusRole role : all_bus_roles) {
    write_role(made.path() / name(role), role, identity, permissions, validity, settings.domains);
  }
  put_in_place(made.path(), place);
  return validity;
}

}  // namespace flinch
