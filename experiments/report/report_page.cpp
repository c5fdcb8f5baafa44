#include "experiments/report/report_page.h"

#include <fstream>

#include "experiments/report/page/page_template.h"
#include "experiments/report/report_json.h"
#include "experiments/report/script_data.h"
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
  const std::string page = report_page(report);
  std::ofstream file(path, std::ios::binary);
  file << page;
  file.close();
  if (!file) throw SetupError("report: cannot write " + path.string());
}

}  // namespace flinch
