#include "drivers/dds_bus.h"

#include <dds/dds.h>

#include "drivers/bus_log.h"
#include "drivers/bus_threads.h"
#include "drivers/dds_qos.h"
#include "drivers/device_binding.h"
#include "systems/foundation/setup_error.h"

namespace flinch {
namespace {

/// A bus without a place for this program says no more than that there was an error.
std::int32_t check_domain(std::int32_t result, const std::string& name) {
  if (result == DDS_RETCODE_ERROR) {
    throw SetupError(name + ": Cyclone DDS says why above; where it finds no free participant index, " +
                     std::to_string(programs_of_domain) +
                     " programs of this machine are on that bus already, of whatever kind: end some, or use "
                     "another --domain at all ends");
  }
  return check_dds(result, name);
}

/// Names the keys where there are some: the result says only that there was an error, the log what it was.
std::int32_t check_participant(std::int32_t result, const BusSettings& settings, const std::string& name) {
  if (result < 0 && settings.security) {
    throw SetupError(
        name + ": the keys of the " + flinch::name(settings.security->role) + " in " +
        settings.security->folder.string() +
        " are refused, Cyclone DDS says why above; they may be expired, for another domain, changed, "
        "or not made together; 'flinch keys' makes new ones");
  }
  return check_domain(result, name);
}

}  // namespace

DdsBus::DdsBus(const BusSettings& settings) {
  throw_if_any(problems(settings));
  tell_bus_log();
  const std::set<pid_t> others = threads_of_program();
  const std::string name = "the bus " + std::to_string(settings.domain) + " on '" + settings.interface + "'";
  domain_ = DdsEntity(
      check_domain(dds_create_domain(settings.domain, cyclone_configuration(settings).c_str()), name));
  bind_bus_to_device(settings.domain, network_device(settings.interface));
  const DdsQos qos(dds_create_qos());
  if (settings.security) {
    for (const auto& [property, value] : participant_properties(*settings.security)) {
      dds_qset_prop(qos.get(), property.c_str(), value.c_str());
    }
  }
  participant_ = DdsEntity(
      check_participant(dds_create_participant(settings.domain, qos.get(), nullptr), settings, name));
  // All of them: the configuration cannot name the one that receives our samples, nor the one that, holding
  // locks which the others wait for, makes friends with every program that joins.
  if (settings.realtime_priority > 0) make_urgent_since(others, settings.realtime_priority);
}

}  // namespace flinch
