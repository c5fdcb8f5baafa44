#include "experiments/report/constraint_lane.h"

#include "experiments/report/vector_columns.h"

namespace flinch {

ConstraintLane::ConstraintLane(const Recording& recording, PageSamples& page) : page_(page) {
  for (const Signal& signal : recording.signals) {
    if (signal.path.starts_with("constraints_")) laws_.emplace_back(recording, signal.path);
  }
  if (laws_.empty()) return;
  lane_ = page.lane("constraints", {"inside", "condition number", "self-collision", "both", "not kept"});
  sigma_kappa_ = page.column("sigma_kappa_reference");
  sigma_sc_ = page.column("sigma_sc_reference");
}

void ConstraintLane::show(std::size_t sample) {
  if (laws_.empty()) return;
  ConstraintState kept;  // of the law that is followed
  for (const auto& law : laws_) {
    const ConstraintState state = law[sample];
    if (state.watched) kept = state;
  }
  was_kept_ = was_kept_ || kept.watched;
  const int mode = kept.watched ? static_cast<int>(kept.mode) : 4;
  page_.set_state(lane_, mode, mode == 4 ? -1 : mode);
  page_.set(sigma_kappa_, kept.sigma_kappa.active ? kept.sigma_kappa.reference : no_value);
  page_.set(sigma_sc_, kept.sigma_sc.active ? kept.sigma_sc.reference : no_value);
}

void ConstraintLane::drop_unless_kept(Report& report) const {
  if (was_kept_) return;
  std::erase_if(report.lanes, [](const ReportLane& lane) { return lane.name == "constraints"; });
  report.columns.erase("sigma_kappa_reference");
  report.columns.erase("sigma_sc_reference");
}

}  // namespace flinch
