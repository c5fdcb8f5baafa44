#include "experiments/report/report_page.h"

#include <fstream>

#include "experiments/report/page/page_template.h"
#include "experiments/report/report_json.h"
#include "systems/foundation/setup_error.h"

namespace flinch {
namespace {

/// JSON that can stand inside a script element: without a "<" that could end the element or open a comment.
std::string inside_script(const std::string& data) {
  std::string text;
  for (const char c : data) {
    if (c == '<') {
      text += "\\u003c";
    } else {
      text += c;
    }
  }
  return text;
}

}  // namespace

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
