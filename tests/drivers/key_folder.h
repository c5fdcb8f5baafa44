#pragma once

#include <ctime>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>

#include "drivers/bus_keys.h"
#include "drivers/bus_security.h"
#include "drivers/key_authority.h"
#include "tests/support/file_bytes.h"
#include "tests/support/temporary_folder.h"

namespace flinch::test {

inline void overwrite(const std::filesystem::path& file, const std::string& text) {
  std::ofstream(file, std::ios::binary) << text;
}

/// Keys of all roles, gone with this.
class KeyFolder {
 public:
  explicit KeyFolder(const BusKeySettings& settings = {}) { make_bus_keys(path(), settings); }

  std::filesystem::path path() const { return parent_.path() / "keys"; }
  std::filesystem::path file(BusRole role, const char* file) const { return path() / name(role) / file; }
  BusSecurity of(BusRole role) const { return {.folder = path(), .role = role}; }

 private:
  TemporaryFolder parent_;
};

/// The text within a signed file.
inline std::string signed_text(const std::filesystem::path& file) {
  std::string text = bytes_of(file);
  const std::string end = "</dds>\r\n";
  text = text.substr(text.find("<?xml"), text.find(end) + end.size() - text.find("<?xml"));
  std::erase(text, '\r');
  return text;
}

/// Lets `change` edit governance and permissions of all roles, and another authority sign them.
inline void sign_anew(const KeyFolder& keys,
                      const std::function<void(std::string& governance, std::string& permissions)>& change) {
  const KeyAuthority authority("another", {.from = std::time(nullptr) - 60, .to = std::time(nullptr) + 3600});
  for (const BusRole role : all_bus_roles) {
    std::string governance = signed_text(keys.file(role, security_file::governance));
    std::string permissions = signed_text(keys.file(role, security_file::permissions));
    change(governance, permissions);
    overwrite(keys.file(role, security_file::governance), authority.sign(governance));
    overwrite(keys.file(role, security_file::permissions), authority.sign(permissions));
    overwrite(keys.file(role, security_file::permissions_authority), authority.certificate());
  }
}

}  // namespace flinch::test
