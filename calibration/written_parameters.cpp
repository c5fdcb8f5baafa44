#include "calibration/written_parameters.h"

#include "experiments/scenario/scenario_calibrations.h"
#include "systems/config/parameter_file.h"
#include "systems/foundation/problems_of_place.h"
#include "systems/foundation/result_file.h"

namespace flinch {

void write_parameters(const std::filesystem::path& file, const std::string& text) {
  out_of("what was found is not written, for it could not be read",
         [&] { check_thresholds(parse_parameter_file(text, file.string())); });
  write_result(file, text);
}

}  // namespace flinch
