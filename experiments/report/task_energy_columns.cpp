#include "experiments/report/task_energy_columns.h"

#include <string>

#include "experiments/report/vector_columns.h"

namespace flinch {
namespace {

constexpr std::array<const char*, TaskEnergies::most> names{"sigma_kappa", "sigma_sc", "task_1", "task_2"};

}  // namespace

TaskEnergyColumns::TaskEnergyColumns(const Recording& recording, PageSamples& page)
    : page_(page), period_(to_seconds(recording.period)) {
  for (const Signal& signal : recording.signals) {
    if (!signal.path.starts_with("energies_")) continue;
    names_.push_back(signal.path);
    laws_.emplace_back(recording, signal.path);
  }
  if (laws_.empty()) return;
  for (std::size_t i = 0; i < names.size(); ++i) {
    energy_[i] = page.column(std::string("energy_") + names[i]);
    rate_[i] = page.column(std::string("energy_rate_") + names[i]);
  }
}

TaskEnergyColumns::Served TaskEnergyColumns::served_at(std::size_t sample, ReactionMode mode) const {
  const bool reacts = mode == ReactionMode::react || mode == ReactionMode::hold;
  Served served;
  if (!reacts && mode != ReactionMode::nominal) return served;
  for (std::size_t law = 0; law < laws_.size(); ++law) {
    if (names_[law].ends_with("_reaction") != reacts) continue;
    const TaskEnergies energies = laws_[law][sample];
    if (energies.valid) served = {law, energies};
  }
  return served;
}

void TaskEnergyColumns::show(std::size_t sample, ReactionMode mode) {
  if (laws_.empty()) return;
  const Served now = served_at(sample, mode);
  for (int i = 0; i < TaskEnergies::most; ++i) {
    const auto place = static_cast<std::size_t>(i);
    const bool is_served = now.energies.serves(i);
    const bool goes_on = is_served && before_.law == now.law && before_.energies.serves(i);
    const double change = now.energies.energy[place] - before_.energies.energy[place];
    page_.set(energy_[place], is_served ? now.energies.energy[place] : no_value);
    page_.set(rate_[place], goes_on ? change / period_ : no_value);
  }
  before_ = now;
}

}  // namespace flinch
