#pragma once

#include "drivers/dds_bus.h"
#include "drivers/topics.h"

struct flinch_Header;

namespace flinch {

/// Sends samples of one topic. For one thread at a time, never that of a control loop: sending may take
/// milliseconds.
class DdsWriter {
 public:
  /// Throws SetupError.
  DdsWriter(const DdsBus& bus, const Topic& topic);

  /// Sends `sample`, a struct of the topic's type. Returns whether it was handed to the bus.
  bool write(const void* sample) noexcept;

 private:
  DdsEntity topic_;
  DdsEntity writer_;
};

}  // namespace flinch
