#include "plant/contact_history.h"

#include <algorithm>
#include <cstddef>

namespace flinch {
namespace {

bool any_penetrates(const PylonGaps& gaps) {
  return std::any_of(gaps.gap.begin(), gaps.gap.end(), [](double gap) { return gap < 0.0; });
}

double strongest_force(const ContactForces& contacts) {
  double strongest = 0.0;
  for (int i = 0; i < contacts.touch_count; ++i) {
    strongest = std::max(strongest, contacts.touches[static_cast<std::size_t>(i)].force_on_robot.norm());
  }
  return strongest;
}

// When `body` crosses from one side to the other between two ticks [s after the first].
double crossing(const PylonGaps& before, const PylonGaps& after, std::size_t body, double duration) {
  return hermite_crossing(before.gap[body], before.rate[body], after.gap[body], after.rate[body], duration);
}

double first_crossing(const PylonGaps& before, const PylonGaps& after, double duration) {
  double first = duration;
  for (std::size_t body = 0; body < bench_body_count; ++body) {
    if (after.gap[body] < 0.0) first = std::min(first, crossing(before, after, body, duration));
  }
  return first;
}

double last_crossing(const PylonGaps& before, const PylonGaps& after, double duration) {
  double last = 0.0;
  for (std::size_t body = 0; body < bench_body_count; ++body) {
    if (before.gap[body] < 0.0) last = std::max(last, crossing(before, after, body, duration));
  }
  return last;
}

}  // namespace

double hermite_crossing(double g0, double rate0, double g1, double rate1, double duration) noexcept {
  const auto value = [&](double s) {
    const double r = 1.0 - s;
    return r * r * ((1.0 + 2.0 * s) * g0 + s * duration * rate0) +
           s * s * ((1.0 + 2.0 * r) * g1 - r * duration * rate1);
  };
  double before = 0.0;
  double after = 1.0;
  constexpr int halvings = 40;
  for (int i = 0; i < halvings; ++i) {
    const double middle = 0.5 * (before + after);
    ((value(middle) < 0.0) == (g0 < 0.0) ? before : after) = middle;
  }
  return 0.5 * (before + after) * duration;
}

ContactHistory ContactHistory::next(Time time, const PylonGaps& gaps_then,
                                    const ContactForces& contacts_then) const noexcept {
  const double duration = to_seconds(time - now);
  ContactHistory then = *this;
  then.started = true;
  then.now = time;
  then.gaps = gaps_then;
  then.in_contact = any_penetrates(gaps_then);
  if (then.in_contact && !in_contact) {
    ++then.contacts;
    then.onset = started ? now + from_seconds(first_crossing(gaps, gaps_then, duration)) : time;
    then.peak_force = 0.0;
  }
  if (then.in_contact) {
    then.end = time;
    then.peak_force = std::max(then.peak_force, strongest_force(contacts_then));
  } else if (in_contact) {
    then.end = now + from_seconds(last_crossing(gaps, gaps_then, duration));
  }
  return then;
}

}  // namespace flinch
