#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

#include "apps/flinch/command_line.h"

namespace flinch {

struct ServeOptions {
  CommonOptions common;
  LiveOptions live;
  std::filesystem::path scenario;
  std::optional<std::uint64_t> seed;
  BusOptions bus;
  std::optional<double> duration;   ///< none: until interrupted [s]
  std::optional<double> patience;   ///< in lockstep, with a controller that sends nothing [s]; none: 10
  std::vector<std::string> faults;  ///< on request, SIGNAL:KIND@TIME[:SIZE]
};

struct LinkOptions {
  CommonOptions common;
  std::filesystem::path robot;  ///< robot file or scenario
  BusOptions bus;
  double duration = 10.0;  ///< [s]
  double patience = 10.0;  ///< [s]
};

struct KeysOptions {
  CommonOptions common;
  std::filesystem::path folder;
  int days = 1096;
  std::optional<std::uint32_t> domain;  ///< none: all
  bool force = false;
};

/// The verbs that need the bus. Each throws SetupError for bad input.
ExitStatus serve(const ServeOptions& options);
ExitStatus link(const LinkOptions& options);
ExitStatus keys(const KeysOptions& options);
/// flinch run --station dds
ExitStatus run_on_bus(const RunOptions& options);

}  // namespace flinch
