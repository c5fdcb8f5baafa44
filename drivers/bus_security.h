#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "drivers/bus_role.h"

namespace flinch {

/// Who this program is on a secured bus, by DDS Security: it talks only to programs whose certificates come
/// from the same make_bus_keys(), and each may send only what its role sends.
struct BusSecurity {
  std::filesystem::path folder;  ///< made by make_bus_keys(); only its subfolder of the role is read
  BusRole role = BusRole::observer;
};

/// The files of each role, in the subfolder that has its name. All are PEM, or text signed as S/MIME.
namespace security_file {
inline constexpr const char* identity_authority = "identity_authority.pem";
inline constexpr const char* permissions_authority = "permissions_authority.pem";
inline constexpr const char* certificate = "certificate.pem";
inline constexpr const char* private_key = "private_key.pem";
inline constexpr const char* governance = "governance.p7s";    ///< how the bus is protected
inline constexpr const char* permissions = "permissions.p7s";  ///< what the role may send and receive

inline constexpr std::array all = {
    identity_authority, permissions_authority, certificate, private_key, governance, permissions};
}  // namespace security_file

/// All that is missing, one sentence each: files, and the plugins of Cyclone DDS that do the work. Whether
/// the files belong together and are valid now is for the plugins to say, when the bus is made.
std::vector<std::string> key_problems(const BusSecurity& security);

/// What the user should know before going on: a private key that others can read, keys that
/// end within 30 days.
std::vector<std::string> key_warnings(const BusSecurity& security);

/// The properties of a participant that make it so, as names and values. The plugins are taken from where
/// the running libddsc was loaded from: from its folder, or the folder beside it that Debian names after its
/// version. So no search path has a say in which code checks the signatures.
std::vector<std::pair<std::string, std::string>> participant_properties(const BusSecurity& security);

}  // namespace flinch
