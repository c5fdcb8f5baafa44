// Data sets of contacts in HDF5.
#include "learning/data_set.h"
#include "systems/config/robot_file.h"
#include "tests/fuzz/fuzz_files.h"
#include "tests/fuzz/fuzz_target.h"
#include "tests/support/file_bytes.h"

namespace flinch::test {
namespace {

void try_data_set(std::string_view bytes) { counts_table(read_data_set(fuzz_file("fuzzed_set.h5", bytes))); }

std::vector<std::string> data_set_seeds() {
  DataSet data;
  data.robot_file = "five_bar.yaml";
  data.robot_text = bytes_of(FLINCH_SOURCE_DIR "/apps/robots/five_bar.yaml");
  data.robot = parse_robot_file(data.robot_text, data.robot_file).robot;
  data.card = {{"title", "two contacts"}, {"seed", "1"}};
  for (int i = 0; i < 2; ++i) {
    DataSample& sample = data.samples.emplace_back();
    sample.run = i;
    sample.touched = i;
    sample.pose = data.robot->home_pose();
    sample.course.fill({PlatformVector::Ones(data.robot->dof()), PlatformVector::Zero(data.robot->dof())});
  }
  const std::filesystem::path file = fuzz_folder() / "seed_set.h5";
  write_data_set(data, file);
  return {bytes_of(file)};
}

}  // namespace

const FuzzTarget data_set_target{"data_set", try_data_set, data_set_seeds};

}  // namespace flinch::test
