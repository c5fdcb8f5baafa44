#include "experiments/report/operator_lane.h"

#include <utility>

namespace flinch {
namespace {

enum Button : std::uint8_t { nothing, target, start, reset, stop };

Button state_of(const OperatorCommand& pressed) {
  if (pressed.stop) return stop;
  if (pressed.reset) return reset;
  return pressed.start ? start : nothing;
}

}  // namespace

OperatorLane::OperatorLane(const Recording& recording, PageSamples& page) : page_(page) {
  if (recording.find("operator") == nullptr) return;
  buttons_.emplace(recording, "operator");
  if (recording.find("target") != nullptr) target_.emplace(recording, "target");
  lane_ = page.lane("operator", {"nothing", "target", "start", "reset", "stop"});
}

void OperatorLane::show(std::size_t sample) {
  if (!buttons_) return;
  const std::uint32_t number = target_ ? (*target_)[sample].number : 0;
  const bool is_given = std::exchange(number_, number) != number;
  const Button pressed = state_of((*buttons_)[sample]);
  const Button state = pressed == nothing && is_given ? target : pressed;
  was_used_ = was_used_ || state != nothing;
  page_.set_state(lane_, state, state);
}

void OperatorLane::drop_unless_used(Report& report) const {
  if (was_used_) return;
  std::erase_if(report.lanes, [](const ReportLane& lane) { return lane.name == "operator"; });
}

}  // namespace flinch
