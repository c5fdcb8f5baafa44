#include "experiments/verdict/return_monitor.h"

#include <algorithm>
#include <string>

#include "experiments/verdict/fault_words.h"

namespace flinch {
namespace {

std::string word(ReactionMode mode) {
  if (mode == ReactionMode::hold) return "hold";
  if (mode == ReactionMode::zero_g) return "zero_g";
  return mode == ReactionMode::react ? "react" : "stopped";
}

}  // namespace

void ReturnMonitor::begin(const RunSample& now) {
  return_ = {.reset = now.time, .from = word(mode_)};
  const bool stopped = mode_ == ReactionMode::stopped;
  if (stopped) return_->stopped_by = description_of(gate_.passes() ? now.gate.fault : gate_.fault);
  const bool closes = gate_.passes() && !now.gate.passes();
  if (closes && !stopped) return_->fault = description_of(now.gate.fault);
}

void ReturnMonitor::go_on(const RunSample& now) {
  const bool closes = gate_.passes() && !now.gate.passes();
  if (closes && return_->fault.empty()) return_->fault = description_of(now.gate.fault);
  if (return_->resumed) return;
  if (now.pressed.reset && !pressed_.reset) ++return_->resets;
  if (now.mode == ReactionMode::react && mode_ != ReactionMode::react) ++return_->reactions;
  if (now.mode == ReactionMode::recover)
    return_->recovery_speed = std::max(return_->recovery_speed, now.speed);
  if (now.mode != ReactionMode::nominal) return;
  const bool moves = now.reference_valid && !now.reference_rests;
  if (now.pressed.start && !pressed_.start && rested_ && moves) {
    return_->resumed = now.time;
  } else {
    return_->nominal_speed = std::max(return_->nominal_speed, now.speed);
  }
}

void ReturnMonitor::see(const RunSample& now) {
  const bool resets = now.pressed.reset && !pressed_.reset;
  if (return_) {
    go_on(now);
  } else if (resets && mode_ != ReactionMode::nominal) {
    begin(now);
  }
  pressed_ = now.pressed;
  mode_ = now.mode;
  gate_ = now.gate;
  rested_ = now.reference_valid && now.reference_rests;
}

}  // namespace flinch
