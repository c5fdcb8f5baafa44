#include "experiments/bus/operator_order.h"

#include <algorithm>
#include <cctype>
#include <vector>

#include "experiments/scenario/scenario.h"
#include "experiments/scenario/scenario_pose.h"
#include "systems/config/config_reader.h"
#include "systems/foundation/nearest_name.h"
#include "systems/foundation/setup_error.h"

namespace flinch {
namespace {

const std::vector<std::string> words = {"stop", "reset", "start", "go", "step", "end", "help"};

bool is_space(char letter) { return std::isspace(static_cast<unsigned char>(letter)) != 0; }

/// The part of `text` before its first space; what follows stays in `text`.
std::string first_word(std::string_view& text) {
  const auto begin = std::find_if_not(text.begin(), text.end(), is_space);
  const auto end = std::find_if(begin, text.end(), is_space);
  const std::string word(begin, end);
  text.remove_prefix(static_cast<std::size_t>(end - text.begin()));
  return word;
}

/// Reads `keys` as the section `word` of a file.
TargetCommand read_target(const std::string& word, std::string_view keys, const ParallelRobot& robot) {
  const std::string from = "order";
  TargetCommand target;
  try {
    ConfigReader reader = ConfigReader::parse(word + ": {" + std::string(keys) + "}", from);
    if (word == "go") {
      target.kind = TargetCommand::Kind::pose;
      target.pose = read_pose_in_reach(reader, word, robot);
    } else {
      target.kind = TargetCommand::Kind::step;
      target.step = read_step(reader.section(word), robot.space());
    }
    reader.finish();
  } catch (const SetupError& error) {
    std::vector<std::string> problems = error.problems();
    for (std::string& problem : problems) {
      if (problem.starts_with(from + ":")) problem.erase(0, problem.find(": ") + 2);
    }
    throw SetupError(problems);
  }
  return target;
}

}  // namespace

OperatorOrder read_order(std::string_view line, const Scenario& scenario) {
  const std::string word = first_word(line);
  OperatorOrder order;
  if (word == "go" || word == "step") {
    order.target = read_target(word, line, *scenario.robot.robot);
    return order;
  }
  if (std::find(words.begin(), words.end(), word) == words.end()) {
    throw SetupError("'" + word + "' is no order" + did_you_mean(word, words));
  }
  if (const std::string more = first_word(line); !more.empty()) {
    throw SetupError("'" + more + "' behind '" + word + "' means nothing");
  }
  if (word == "start" && !scenario.control.trajectory.path) {
    throw SetupError("'start' begins the motion of the scenario, which has none; 'go' leads elsewhere");
  }
  order.buttons = {.start = word == "start", .reset = word == "reset", .stop = word == "stop"};
  order.end = word == "end";
  return order;
}

std::string_view known_orders() {
  return "stop     come to rest; the torque gate closes until a reset\n"
         "reset    once it rests: acknowledge a reaction or fault. Drives that are off go on; then reset "
         "again\n"
         "start    go to the begin of the motion and follow it\n"
         "go       to a pose by its keys in a scenario, as in 'go x_mm: 20'; those left out are home's\n"
         "step     by a displacement, as in 'step x_mm: 5'\n"
         "end      end the run: come to rest, drives off, report\n";
}

}  // namespace flinch
