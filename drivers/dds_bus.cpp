#include "drivers/dds_bus.h"

#include <dds/dds.h>

#include "systems/foundation/setup_error.h"

namespace flinch {

DdsBus::DdsBus(const BusSettings& settings) {
  throw_if_any(problems(settings));
  const std::string name = "the bus " + std::to_string(settings.domain) + " on '" + settings.interface + "'";
  domain_ =
      DdsEntity(check_dds(dds_create_domain(settings.domain, cyclone_configuration(settings).c_str()), name));
  participant_ = DdsEntity(check_dds(dds_create_participant(settings.domain, nullptr, nullptr), name));
}

}  // namespace flinch
