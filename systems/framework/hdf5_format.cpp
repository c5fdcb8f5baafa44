#include "systems/framework/hdf5_format.h"

#include <mutex>

#include "systems/foundation/setup_error.h"
#include "systems/framework/hdf5_object.h"

namespace flinch {

std::string hdf5_format(const std::filesystem::path& file) {
  const std::scoped_lock lock(internal::hdf5_mutex());
  try {
    return internal::read_text(internal::open_hdf5_file(file), "format");
  } catch (const SetupError&) {
    return "";  // whoever reads it as what it may be says what is wrong
  }
}

}  // namespace flinch
