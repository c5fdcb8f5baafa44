// An access control plugin for Cyclone DDS as an intruder would patch it: as the real one, which the
// environment names, but its own program may make every writer.
#include <dds/security/dds_security_api_access_control.h>
#include <dlfcn.h>

#include <cstdlib>

namespace {

using Init = int (*)(const char*, void**, struct ddsi_domaingv*);
using Finalize = int (*)(void*);

void* real_plugin() {
  static void* const plugin = dlopen(std::getenv("REAL_ACCESS_CONTROL"), RTLD_NOW | RTLD_LOCAL);
  return plugin;
}

DDS_Security_boolean allow_writer(dds_security_access_control*, DDS_Security_PermissionsHandle,
                                  DDS_Security_DomainId, const char*, const DDS_Security_Qos*,
                                  const DDS_Security_PartitionQosPolicy*, const DDS_Security_DataTags*,
                                  DDS_Security_SecurityException*) {
  return true;
}

}  // namespace

extern "C" int init_access_control(const char* argument, void** context, struct ddsi_domaingv* domain) {
  const auto init = reinterpret_cast<Init>(dlsym(real_plugin(), "init_access_control"));
  const int result = init(argument, context, domain);
  if (result == 0) {
    static_cast<dds_security_access_control*>(*context)->check_create_datawriter = &allow_writer;
  }
  return result;
}

extern "C" int finalize_access_control(void* context) {
  return reinterpret_cast<Finalize>(dlsym(real_plugin(), "finalize_access_control"))(context);
}
