#include "drivers/bus_security.h"

#include <dds/dds.h>
#include <dlfcn.h>

#include <array>
#include <ctime>
#include <fstream>
#include <sstream>

namespace flinch {
namespace {

namespace fs = std::filesystem;

/// A plugin of Cyclone DDS.
struct Plugin {
  const char* property;  ///< between "dds.sec." and ".library"
  const char* file;
  const char* function;  ///< after "init_" and "finalize_"
};

constexpr std::array plugins = {Plugin{"auth", "libdds_security_auth.so", "authentication"},
                                Plugin{"crypto", "libdds_security_crypto.so", "crypto"},
                                Plugin{"access", "libdds_security_ac.so", "access_control"}};

/// The file of libddsc that this program runs with; empty where it is part of the program.
fs::path cyclone_library() {
  Dl_info info{};
  if (dladdr(reinterpret_cast<const void*>(&dds_create_participant), &info) == 0) return {};
  return info.dli_fname;
}

/// Beside libddsc.so.VERSION, or in the folder libddscVERSION beside it; empty where it is in neither.
fs::path find(const Plugin& plugin) {
  const fs::path library = cyclone_library();
  const std::string file = library.filename();
  const std::string ending = ".so.";
  std::vector<fs::path> folders = {library.parent_path()};
  if (const auto at = file.find(ending); at != std::string::npos) {
    folders.push_back(library.parent_path() / (file.substr(0, at) + file.substr(at + ending.size())));
  }
  std::error_code error;
  for (const fs::path& folder : folders) {
    if (fs::is_regular_file(folder / plugin.file, error)) return fs::absolute(folder / plugin.file);
  }
  return {};
}

fs::path path_of(const BusSecurity& security, const char* file) {
  return fs::absolute(security.folder) / name(security.role) / file;
}

std::string text_of(const fs::path& path) {
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
}

/// When the permissions end, as they write it; empty where they say nothing.
std::string end_of(const BusSecurity& security) {
  const std::string text = text_of(path_of(security, security_file::permissions));
  const std::string tag = "<not_after>";
  const std::size_t at = text.find(tag);
  if (at == std::string::npos) return "";
  return text.substr(at + tag.size(), text.find('<', at + tag.size()) - at - tag.size());
}

/// Whether less than 30 days remain until `date`, in UTC.
bool is_near(const std::string& date) {
  std::tm end{};
  if (::strptime(date.c_str(), "%Y-%m-%dT%H:%M:%SZ", &end) == nullptr) return false;
  constexpr double near = 30.0 * 86400.0;  // [s]
  return std::difftime(::timegm(&end), std::time(nullptr)) < near;
}

}  // namespace

std::vector<std::string> key_problems(const BusSecurity& security) {
  if (security.folder.empty()) {
    return {"the security of the bus needs the folder of its keys; 'flinch keys DIR' makes one"};
  }
  std::vector<std::string> found;
  std::error_code error;
  for (const char* file : security_file::all) {
    const fs::path path = path_of(security, file);
    if (!fs::is_regular_file(path, error)) {
      found.push_back(path.string() +
                      ": the security of the bus needs this file; 'flinch keys DIR' makes it");
    }
  }
  for (const Plugin& plugin : plugins) {
    if (find(plugin).empty()) {
      found.push_back(std::string(plugin.file) + ": the security of the bus needs this plugin beside " +
                      cyclone_library().string() + "; this Cyclone DDS was built without security");
    }
  }
  return found;
}

std::vector<std::string> key_warnings(const BusSecurity& security) {
  std::vector<std::string> found;
  const fs::path key = path_of(security, security_file::private_key);
  std::error_code error;
  const fs::perms others = fs::perms::group_all | fs::perms::others_all;
  const fs::file_status status = fs::status(key, error);
  if (fs::exists(status) && (status.permissions() & others) != fs::perms::none) {
    found.push_back(key.string() +
                    ": others on this machine may read this private key; 'chmod 600' keeps them out");
  }
  const fs::perms writers = fs::perms::group_write | fs::perms::others_write;
  for (const fs::path& folder : {security.folder, key.parent_path()}) {
    const fs::file_status folder_status = fs::status(folder, error);
    if (!fs::exists(folder_status) || (folder_status.permissions() & writers) == fs::perms::none) continue;
    found.push_back(folder.string() +
                    ": others on this machine may put their keys into this folder; 'chmod go-w' keeps them "
                    "out");
  }
  if (const std::string end = end_of(security); is_near(end)) {
    found.push_back(security.folder.string() + ": these keys end at " + end +
                    ", and with them a running link; 'flinch keys' makes new ones");
  }
  return found;
}

std::vector<std::pair<std::string, std::string>> participant_properties(const BusSecurity& security) {
  std::vector<std::pair<std::string, std::string>> properties;
  for (const Plugin& plugin : plugins) {
    const std::string library = std::string("dds.sec.") + plugin.property + ".library.";
    properties.emplace_back(library + "path", find(plugin).string());
    properties.emplace_back(library + "init", std::string("init_") + plugin.function);
    properties.emplace_back(library + "finalize", std::string("finalize_") + plugin.function);
  }
  const auto add = [&](const char* property, const char* file) {
    properties.emplace_back(property, "file:" + path_of(security, file).string());
  };
  add("dds.sec.auth.identity_ca", security_file::identity_authority);
  add("dds.sec.auth.identity_certificate", security_file::certificate);
  add("dds.sec.auth.private_key", security_file::private_key);
  add("dds.sec.access.permissions_ca", security_file::permissions_authority);
  add("dds.sec.access.governance", security_file::governance);
  add("dds.sec.access.permissions", security_file::permissions);
  return properties;
}

}  // namespace flinch
