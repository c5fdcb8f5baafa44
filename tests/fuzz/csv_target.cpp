// Logs of other tools: a mapping, a line "---", and the CSV file that it names.
#include "import/imported_recording.h"
#include "tests/fuzz/fuzz_files.h"
#include "tests/fuzz/fuzz_target.h"
#include "tests/fuzz/read_recording.h"

namespace flinch::test {
namespace {

const std::string between = "\n---\n";

void try_csv(std::string_view bytes) {
  const std::size_t end = bytes.find(between);
  fuzz_file("log.csv", end == std::string_view::npos ? "" : bytes.substr(end + between.size()));
  read_all_of(import_log(fuzz_file("mapping.yaml", bytes.substr(0, end))));
}

std::vector<std::string> csv_seeds() {
  std::string mapping = "csv: log.csv\nscenario: " FLINCH_SOURCE_DIR
                        "/apps/scenarios/five_bar_collision.yaml\nseparator: ','\nperiod_ms: 1\n"
                        "time: {column: t, unit: s}\ncolumns:\n";
  for (const char* const entry : {"0", "1"}) {
    const std::string n = entry;
    mapping += "  - {column: q" + n + ", signal: joints.active, entry: " + n + ", unit: deg, sign: -1}\n";
    mapping += "  - {column: i" + n + ", signal: drives.current, entry: " + n + ", unit: A}\n";
  }
  return {mapping + between + "t,q0,q1,i0,i1\n0,10,20,1,2\n0.001,10.1,20,1,2\n0.002,10.2,20,1,+2e-1\n"};
}

}  // namespace

const FuzzTarget csv_target{"csv", try_csv, csv_seeds};

}  // namespace flinch::test
