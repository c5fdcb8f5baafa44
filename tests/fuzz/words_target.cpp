// What the command line reads beyond plain numbers and names: a fault that is asked for, and, after a line's
// end, a value for a key of a scenario.
#include "diagrams/requested_fault.h"
#include "systems/config/config_node.h"
#include "systems/config/robot_file.h"
#include "systems/config/yaml_text.h"
#include "systems/foundation/setup_error.h"
#include "tests/fuzz/fuzz_files.h"
#include "tests/fuzz/fuzz_target.h"
#include "tests/support/file_bytes.h"

namespace flinch::test {
namespace {

void set_value(const std::string& text) {
  static const auto scenario =
      parse_yaml(bytes_of(FLINCH_SOURCE_DIR "/apps/scenarios/platform_collision.yaml"), "scenario.yaml");
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos) return;
  yaml_text(*with_value(*scenario, text.substr(0, equals), parse_yaml(text.substr(equals + 1), "--set")));
}

void try_words(std::string_view bytes) {
  static const auto robot = load_robot(FLINCH_SOURCE_DIR "/apps/robots/planar_3rrr.yaml");
  const std::string text(bytes);
  const std::size_t end = text.find('\n');
  if (end != std::string::npos) set_value(text.substr(end + 1));
  const RequestedFault fault = parse_fault(text.substr(0, end), *robot);
  parse_fault(text_of(fault), *robot);  // what it writes it reads
}

std::vector<std::string> words_seeds() {
  return {"encoder2:drifting@0.5:-5\nmotion.speed_m_per_s=0.3",
          "drives:off@1\ncontrol.contact_detector.reaction_force_N=[1, {a: 2}]", "brakes:delayed@0.2:0.01"};
}

}  // namespace

const FuzzTarget words_target{"words", try_words, words_seeds};

}  // namespace flinch::test
