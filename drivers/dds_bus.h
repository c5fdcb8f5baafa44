#pragma once

#include "drivers/bus_settings.h"
#include "drivers/dds_entity.h"

namespace flinch {

/// This program's place on the bus. It must outlive whatever sends and receives there.
class DdsBus {
 public:
  /// Throws SetupError for settings that make no bus, an interface that is not there, keys that do not
  /// fit, sockets that cannot be kept to the interface, or a second bus of the same domain in one program.
  explicit DdsBus(const BusSettings& settings = {});

  std::int32_t participant() const noexcept { return participant_.handle(); }

 private:
  DdsEntity domain_;
  DdsEntity participant_;
};

}  // namespace flinch
