#include "experiments/report/task_energy_columns.h"

#include <string>

#include "experiments/report/vector_columns.h"

namespace flinch {
namespace {

constexpr std::array<const char*, TaskEnergies::most> names{"sigma_kappa", "sigma_sc", "task_1", "task_2"};

}  // namespace

TaskEnergyColumns::TaskEnergyColumns(const Recording& recording, PageSamples& page)
    : page_(page), period_(to_seconds(recording.period)) {
  if (recording.find("energies_nominal") != nullptr) nominal_.emplace(recording, "energies_nominal");
  if (recording.find("energies_reaction") != nullptr) reaction_.emplace(recording, "energies_reaction");
  if (!is_there()) return;
  for (std::size_t i = 0; i < names.size(); ++i) {
    energy_[i] = page.column(std::string("energy_") + names[i]);
    rate_[i] = page.column(std::string("energy_rate_") + names[i]);
  }
}

TaskEnergyColumns::Served TaskEnergyColumns::served_at(std::size_t sample, ReactionMode mode) const {
  const bool reacts = mode == ReactionMode::react || mode == ReactionMode::hold;
  if (reacts && reaction_) return {reacts, (*reaction_)[sample]};
  if (mode == ReactionMode::nominal && nominal_) return {reacts, (*nominal_)[sample]};
  return {};
}

void TaskEnergyColumns::show(std::size_t sample, ReactionMode mode) {
  if (!is_there()) return;
  const Served now = served_at(sample, mode);
  for (int i = 0; i < TaskEnergies::most; ++i) {
    const auto place = static_cast<std::size_t>(i);
    const bool is_served = now.energies.serves(i);
    const bool goes_on = is_served && before_.reacts == now.reacts && before_.energies.serves(i);
    const double change = now.energies.energy[place] - before_.energies.energy[place];
    page_.set(energy_[place], is_served ? now.energies.energy[place] : no_value);
    page_.set(rate_[place], goes_on ? change / period_ : no_value);
  }
  before_ = now;
}

}  // namespace flinch
