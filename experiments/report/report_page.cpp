#include "experiments/report/report_page.h"

#include "experiments/report/page/page_template.h"
#include "experiments/report/report_json.h"
#include "experiments/report/script_data.h"
#include "systems/foundation/result_file.h"
#include "systems/foundation/setup_error.h"

namespace flinch {
std::string report_page(const Report& report) {
  check_report(report);
  std::string page(page_template_before_data);
  page += inside_script(report_json(report));
  page += page_template_after_data;
  return page;
}

void write_report_page(const Report& report, const std::filesystem::path& path) {
  write_result(path, report_page(report));
}

}  // namespace flinch
