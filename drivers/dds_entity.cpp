#include "drivers/dds_entity.h"

#include <dds/dds.h>

#include "systems/foundation/setup_error.h"

namespace flinch {

std::int32_t check_dds(std::int32_t result, const std::string& what) {
  if (result < 0) throw SetupError(what + ": " + dds_strretcode(result));
  return result;
}

DdsEntity::~DdsEntity() {
  if (handle_ > 0) dds_delete(handle_);
}

}  // namespace flinch
