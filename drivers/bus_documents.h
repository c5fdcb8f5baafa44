#pragma once

#include <cstdint>
#include <ctime>
#include <string>

#include "drivers/bus_role.h"

namespace flinch {

/// From when to when keys are good, as seconds of the wall clock since 1970.
struct KeyValidity {
  std::time_t from = 0;
  std::time_t to = 0;
};

/// The domains that keys are good for, from `first` to `last`.
struct DomainRange {
  std::uint32_t first = 0;
  std::uint32_t last = 230;
};

/// The governance document of DDS Security: nobody without a certificate takes part, nobody sends or receives
/// what the permissions do not name, and every message carries a code for each of its receivers, from which
/// that receiver, and it alone, sees that it comes from the sender named in it, unchanged. Nothing is
/// encrypted.
std::string governance_document(const DomainRange& domains);

/// The permissions of `role`, whose certificate has this subject (RFC 2253): to send the topics of
/// all_topics() that name it as their sender; to receive everything, but for the robot only what a controller
/// sends it.
std::string permissions_document(BusRole role, const std::string& subject, const KeyValidity& validity,
                                 const DomainRange& domains);

}  // namespace flinch
