#include "experiments/campaign/campaign_run.h"

#include <array>
#include <cmath>
#include <memory>

#include "experiments/campaign/campaign.h"
#include "experiments/campaign/drawn_contact.h"
#include "systems/config/config_node.h"
#include "systems/config/parsed.h"
#include "systems/config/yaml_text.h"
#include "systems/foundation/setup_error.h"
#include "systems/framework/random.h"

namespace flinch {
namespace {

using Node = std::shared_ptr<const ConfigNode>;

Node number_node(double value) { return scalar_node(exact_text(value)); }

double drawn_number(const CampaignDraw& draw, RandomGenerator& random) {
  if (draw.scale == CampaignDraw::Scale::linear) return random.uniform(draw.from, draw.to);
  return std::exp(random.uniform(std::log(draw.from), std::log(draw.to)));
}

Node drawn_value(const CampaignDraw& draw, RandomGenerator& random) {
  if (!draw.of.empty()) return draw.of[random() % draw.of.size()];
  ConfigNode number = *number_node(drawn_number(draw, random));
  number.file = draw.file;
  number.line = draw.line;
  return std::make_shared<const ConfigNode>(std::move(number));
}

/// Picks one of `count` by the next digit of `index`, and takes the digit off.
std::size_t next_digit(std::size_t& index, std::size_t count) {
  const std::size_t digit = index % count;
  index /= count;
  return digit;
}

/// A scenario while values are put into it.
class Draft {
 public:
  Draft(const Campaign& campaign, std::size_t scenario)
      : file_(campaign.scenarios[scenario]), root_(campaign.scenario_nodes[scenario]) {}

  void set(const std::string& key, const Node& value) { root_ = with_value(*root_, key, value); }
  bool has(const std::string& key) const {
    for (const ConfigNode::Entry& entry : root_->entries) {
      if (entry.key == key) return true;
    }
    return false;
  }
  const Node& root() const { return root_; }
  const std::filesystem::path& file() const { return file_; }

 private:
  std::filesystem::path file_;
  Node root_;
};

/// Stands the first obstacle where it is run into. False where this draw has no such place.
bool place_obstacle(RobotFiles& robots, Draft& draft, const std::string& kind, RandomGenerator& random,
                    CampaignRun& run) {
  const Scenario scenario = parse_scenario(draft.root(), draft.file(), robots);
  if (scenario.obstacles.empty()) throw SetupError("there is no obstacle that 'contact' could move");
  const auto contact = draw_contact(scenario, kind, scenario.obstacles.front().shape, random);
  if (!contact) return false;
  const std::string obstacle = draft.has("pylon") ? "pylon." : "obstacles[0].";
  static constexpr std::array axes = {"x_m", "y_m", "z_m"};
  const int directions = scenario.robot.robot->space_dimension();
  run.values.emplace_back("contact", contact->body);
  for (int i = 0; i < 3; ++i) {
    const char* const axis = axes[static_cast<std::size_t>(i)];
    const Node place = number_node(contact->position_in_base[i]);
    if (i < directions) draft.set(obstacle + axis, place);
    run.values.emplace_back(axis, place->scalar);
  }
  return true;
}

/// Draws everything once. False, or SetupError, where that is not possible.
bool draw_once(const Campaign& campaign, RandomGenerator& random, CampaignRun& run) {
  run.values.clear();
  std::size_t digits = run.point;
  const std::size_t base = next_digit(digits, campaign.scenarios.size());
  Draft draft(campaign, base);
  if (campaign.scenarios.size() > 1) {
    run.values.emplace_back("scenario", campaign.scenarios[base].stem().string());
  }
  const auto set = [&](const std::string& key, const Node& value) {
    draft.set(key, value);
    run.values.emplace_back(key, yaml_line(*value));
  };
  for (const CampaignAxis& axis : campaign.grid)
    set(axis.key, axis.values[next_digit(digits, axis.values.size())]);
  for (const CampaignDraw& draw : campaign.drawn) set(draw.key, drawn_value(draw, random));
  draft.set("seed", scalar_node(std::to_string(run.seed)));
  if (campaign.contact) {
    const auto& bodies = campaign.contact->bodies;
    const std::string& kind = bodies[next_digit(digits, bodies.size())];
    if (!place_obstacle(*campaign.robots, draft, kind, random, run)) return false;
  }
  run.scenario = parse_simulated_scenario(draft.root(), draft.file(), *campaign.robots);
  return true;
}

/// The problems, each after the run and what was drawn for it.
std::vector<std::string> of_run(const CampaignRun& run, const std::vector<std::string>& problems) {
  std::string drawn;
  for (const auto& [key, value] : run.values) drawn += (drawn.empty() ? "" : ", ") + key + " = " + value;
  std::vector<std::string> result;
  for (const std::string& problem : problems) {
    result.push_back("run " + std::to_string(run.number) + (drawn.empty() ? "" : " (" + drawn + ")") + ": " +
                     problem);
  }
  return result;
}

}  // namespace

CampaignRun draw_run(const Campaign& campaign, std::size_t number) {
  CampaignRun run;
  run.number = number;
  run.point = number / campaign.draws;
  run.draw = number % campaign.draws;
  const std::uint64_t of_draw = derive_seed(campaign.seed, "draw " + std::to_string(run.draw));
  run.seed = derive_seed(of_draw, "noise");
  RandomGenerator random(derive_seed(of_draw, "values"));
  const bool draws_again = !campaign.drawn.empty() || campaign.contact;
  for (run.attempts = 1;; ++run.attempts) {
    const bool is_last = !draws_again || run.attempts >= most_attempts;
    try {
      if (draw_once(campaign, random, run)) return run;
      if (is_last) throw SetupError("no body moves as 'contact' asks, in none of the draws");
    } catch (const SetupError& error) {
      if (is_last) throw SetupError(of_run(run, error.problems()));
    }
  }
}

}  // namespace flinch
