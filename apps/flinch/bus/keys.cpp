#include <fmt/chrono.h>
#include <fmt/core.h>

#include <nlohmann/json.hpp>

#include "apps/flinch/bus/bus_verbs.h"
#include "apps/flinch/printing.h"
#include "drivers/bus_keys.h"
#include "systems/foundation/json_text.h"

namespace flinch {
namespace {

std::string utc_day(std::time_t time) { return fmt::format("{:%Y-%m-%d}", fmt::gmtime(time)); }

void print_json(const std::filesystem::path& folder, const std::string& end) {
  nlohmann::ordered_json roles;
  for (const BusRole role : all_bus_roles) roles[name(role)] = (folder / name(role)).string();
  print_result("{}\n", json_text(nlohmann::ordered_json{{"keys", roles}, {"good_until", end}}));
}

}  // namespace

ExitStatus keys(const KeysOptions& options) {
  BusKeySettings settings{.days = options.days, .domains = {}, .replace = options.force};
  if (options.domain) settings.domains = {.first = *options.domain, .last = *options.domain};
  const std::string end = utc_day(make_bus_keys(options.folder, settings).to);
  if (options.common.json) {
    print_json(options.folder, end);
  } else if (!options.common.quiet) {
    print_result("keys: {}, good until {}\n", options.folder.string(), end);
    print_message(
        "Give each computer only the subfolder of what runs there: controller, robot or observer.\n");
  }
  return ExitStatus::done;
}

}  // namespace flinch
