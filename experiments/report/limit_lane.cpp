#include "experiments/report/limit_lane.h"

#include <array>
#include <vector>

#include "systems/robot/motion_barriers.h"

namespace flinch {
namespace {

struct NamedLimit {
  std::uint32_t bit;
  const char* name;
};

constexpr std::uint32_t bit_of(BarrierKind kind) { return 1U << static_cast<unsigned>(kind); }

constexpr std::array named_limits = {
    NamedLimit{bit_of(BarrierKind::condition_number), "condition number"},
    NamedLimit{bit_of(BarrierKind::type_1_singularity), "type I singularity"},
    NamedLimit{bit_of(BarrierKind::type_2_singularity), "type II singularity"},
    NamedLimit{bit_of(BarrierKind::self_collision), "self-collision"},
    NamedLimit{bit_of(BarrierKind::distance), "distance"},
    NamedLimit{bit_of(BarrierKind::rotation), "rotation"},
    NamedLimit{bit_of(BarrierKind::drive_range), "range of a drive"},
    NamedLimit{LimitStatus::platform_speed, "speed of the platform"},
    NamedLimit{LimitStatus::drive_speed, "speed of a drive"},
};

constexpr std::uint32_t all_named = [] {
  std::uint32_t bits = 0;
  for (const NamedLimit& limit : named_limits) bits |= limit.bit;
  return bits;
}();

enum KeptState : std::uint8_t { not_kept, kept, not_possible };

}  // namespace

std::string limits_in_words(std::uint32_t binding) {
  std::vector<std::string> names;
  for (const NamedLimit& limit : named_limits) {
    if ((binding & limit.bit) != 0) names.emplace_back(limit.name);
  }
  std::string words;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (i > 0) words += i + 1 == names.size() ? " and " : ", ";
    words += names[i];
  }
  return words;
}

LimitLane::LimitLane(const Recording& recording, PageSamples& page) : page_(page) {
  if (recording.find("limits") == nullptr) return;
  limits_.emplace(recording, "limits");
  lane_ = page.lane(name, {"not kept", "kept", "could not be kept"});
}

void LimitLane::show(std::size_t sample) {
  if (!limits_) return;
  const LimitStatus status = (*limits_)[sample];
  const int state = state_of(status);
  kept_ = kept_ || state != not_kept;
  const bool binds = state != not_kept && state != kept;
  page_.set_state(lane_, state, static_cast<double>(state != not_kept) + binds + status.slack);
}

int LimitLane::state_of(const LimitStatus& status) {
  if (!status.keeping) return not_kept;
  if (!status.valid) return not_possible;
  const std::uint32_t binding = status.binding & all_named;
  if (binding == 0) return kept;
  const bool has_slack = status.slack > least_slack;
  const auto [found, is_new] = binding_.try_emplace({binding, has_slack}, 0);
  if (is_new) {
    const char* const beyond = has_slack ? ", more than the drives have" : "";
    found->second = page_.add_state(lane_, limits_in_words(binding) + beyond);
  }
  return found->second;
}

void LimitLane::drop_unless_kept(Report& report) const {
  if (!kept_) std::erase_if(report.lanes, [](const ReportLane& lane) { return lane.name == name; });
}

}  // namespace flinch
