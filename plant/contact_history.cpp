#include "plant/contact_history.h"

#include <algorithm>
#include <cstddef>

namespace flinch {
namespace {

bool any_penetrates(const NearPairs& near) {
  const auto end = near.pairs.begin() + near.count;
  return std::any_of(near.pairs.begin(), end, [](const NearPair& pair) { return pair.gap < 0.0; });
}

double strongest_force(const ContactForces& contacts) {
  double strongest = 0.0;
  for (int i = 0; i < contacts.touch_count; ++i) {
    strongest = std::max(strongest, contacts.touches[static_cast<std::size_t>(i)].force_on_robot.norm());
  }
  return strongest;
}

// When a pair that penetrates on one side of a tick, and not on the other, crosses [s after its start]. A
// pair that was not near on the other side crosses there.
double crossing(const NearPair* before, const NearPair* after, double duration, double otherwise) {
  if (before == nullptr || after == nullptr || (before->gap < 0.0) == (after->gap < 0.0)) return otherwise;
  return hermite_crossing(before->gap, before->rate, after->gap, after->rate, duration);
}

double first_crossing(const NearPairs& before, const NearPairs& after, double duration) {
  double first = duration;
  for (int i = 0; i < after.count; ++i) {
    const NearPair& pair = after.pairs[static_cast<std::size_t>(i)];
    if (pair.gap >= 0.0) continue;
    first = std::min(first, crossing(before.find(pair.body, pair.obstacle), &pair, duration, duration));
  }
  return first;
}

double last_crossing(const NearPairs& before, const NearPairs& after, double duration) {
  double last = 0.0;
  for (int i = 0; i < before.count; ++i) {
    const NearPair& pair = before.pairs[static_cast<std::size_t>(i)];
    if (pair.gap >= 0.0) continue;
    last = std::max(last, crossing(&pair, after.find(pair.body, pair.obstacle), duration, 0.0));
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

ContactHistory ContactHistory::next(Time time, const NearPairs& pairs_then,
                                    const ContactForces& contacts_then) const noexcept {
  const double duration = to_seconds(time - now);
  ContactHistory then = *this;
  then.started = true;
  then.now = time;
  then.pairs = pairs_then;
  then.in_contact = any_penetrates(pairs_then);
  if (then.in_contact && !in_contact) {
    ++then.contacts;
    then.onset = started ? now + from_seconds(first_crossing(pairs, pairs_then, duration)) : time;
    then.peak_force = 0.0;
  }
  if (then.in_contact) {
    then.end = time;
    then.peak_force = std::max(then.peak_force, strongest_force(contacts_then));
  } else if (in_contact) {
    then.end = now + from_seconds(last_crossing(pairs, pairs_then, duration));
  }
  return then;
}

}  // namespace flinch
