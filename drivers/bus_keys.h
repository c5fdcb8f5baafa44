#pragma once

#include <filesystem>

#include "drivers/bus_documents.h"

namespace flinch {

struct BusKeySettings {
  int days = 1096;  ///< from now on that the keys are good for, 1 to 36500
  DomainRange domains = {};
  bool replace = false;  ///< keys that are there already
};

/// Makes all that secures a bus: in `folder` a subfolder for each BusRole, named after it, with its private
/// key and all else that a program of that role reads; see BusSecurity. Those of one making fit together, and
/// with no others. The authorities' private keys are not kept, so nobody can add to them; who needs one more,
/// or later ones, makes all of them anew.
///
/// Good from a day ago, for computers whose clocks disagree. The folders are for their owner only (mode
/// 0700), private keys too (0600). Returns how long the keys are good. Makes all or nothing; throws
/// SetupError, also where something is in `folder` already, unless it is to be replaced and is nothing but
/// such keys.
KeyValidity make_bus_keys(const std::filesystem::path& folder, const BusKeySettings& settings = {});

}  // namespace flinch
