#include "experiments/verdict/contact_watch.h"

#include <algorithm>
#include <cmath>

#include "systems/robot/body_id.h"

namespace flinch {

void ContactWatch::see(const RunSample& now, double period) {
  const bool touches = now.load() > 1.0;
  if (touches && !(is_open_ && now.time - last_ < Verdict::same_contact)) begin(now);
  if (is_open_) {
    if (pending_clamping_.empty() && now.clamping) {
      pending_clamping_ = "leg" + std::to_string(BodyId::from_index(now.body).leg() + 1) + "_clamping";
    }
    if (touches) extend(now, period);
    if (now.time < last_ + Verdict::same_contact) {
      note_detections(now);
      note_classification(now);
      note_braking(now);
      note_task(now);
    }
  }
  before_ = now;
}

/// By the present levels; a latched one would not do: of a second contact it knows nothing.
void ContactWatch::note_detections(const RunSample& now) {
  ContactVerdict& contact = contacts_.back();
  for (std::size_t i = 0; i < contact.detected_by.size() && i < now.noticed_by.size(); ++i) {
    std::optional<double>& detected = contact.detected_by[i].detected;
    if (now.noticed_by[i] && !detected) detected = now.time;
  }
  if (now.detection.present_level != ContactLevel::none && !contact.detected) contact.detected = now.time;
}

void ContactWatch::note_classification(const RunSample& now) {
  ContactVerdict& contact = contacts_.back();
  if (now.classified.empty() || contact.classified_at || !contact.detected) return;
  contact.classified = now.classified;
  contact.classified_at = now.time;
  contact.probability = now.probability;
  const ContactLocation& found = now.location;
  if (!now.is_true || now.is_pushed() || !found.valid || !found.located) return;
  if (found.point_in_base.size() != now.touched_point.size() || now.touched_point.size() == 0) return;
  contact.location_error = (found.point_in_base - now.touched_point).norm();
  contact.force_error = (found.force_in_base - now.touched_force).norm();
}

void ContactWatch::note_braking(const RunSample& now) {
  ContactVerdict& contact = contacts_.back();
  const BrakingStatus& found = now.braking;
  if (contact.could_stop || !found.valid || to_seconds(found.judged) < contact.onset) return;
  contact.could_stop = found.stays_inside;
  if (std::isfinite(found.duration)) contact.stop_duration = found.duration;
}

void ContactWatch::note_task(const RunSample& now) {
  ContactVerdict& contact = contacts_.back();
  if (!now.task.valid || !contact.detected || now.mode == ReactionMode::hold) return;
  std::vector<TaskBegin>& tasks = contact.reaction_tasks;
  if (tasks.empty() || tasks.back().task != now.task) tasks.push_back({now.task, now.time});
}

std::vector<ContactVerdict> ContactWatch::contacts() const {
  std::vector<ContactVerdict> judged = contacts_;
  if (is_open_ && before_->time - last_ < Verdict::same_contact) judged.back().removed.reset();
  for (ContactVerdict& contact : judged) limit_force(contact);
  return judged;
}

void ContactWatch::begin(const RunSample& now) {
  ContactVerdict contact;
  contact.onset = now.time;
  contact.speed = now.speed;
  if (before_ && !std::isnan(before_->load())) {
    const double share = onset_share(now);
    contact.onset = before_->time + share * (now.time - before_->time);
    contact.speed = before_->speed + share * (now.speed - before_->speed);
  }
  contact.peak_force = -1.0;
  for (const std::string& estimator : estimators_) contact.detected_by.push_back({estimator, std::nullopt});
  contacts_.push_back(contact);
  pending_clamping_.clear();
  clamps_ = false;
  is_open_ = true;
}

/// Of the time between the sample before and this one, until the load rose above that of a contact.
double ContactWatch::onset_share(const RunSample& now) const {
  return (1.0 - before_->load()) / (now.load() - before_->load());
}

void ContactWatch::extend(const RunSample& now, double period) {
  ContactVerdict& contact = contacts_.back();
  last_ = now.time;
  contact.removed = now.time + period;
  const bool lasts = now.time - contact.onset > limits_.transient_duration;
  if (lasts) {
    contact.lasting_force = std::max(contact.lasting_force.value_or(0.0), now.force());
  }
  if (now.force() > (lasts ? limits_.quasi_static : limits_.transient)) contact.over_limit += period;
  name_body(now, contact);
  if (now.force() > contact.peak_force) {
    contact.peak_force = now.force();
    contact.peak_time = now.time;
  }
  pending_clamping_.clear();
}

/// A leg's clamping where that happens during the contact, else the body with the peak force.
void ContactWatch::name_body(const RunSample& now, ContactVerdict& contact) {
  if (!now.is_true) return;
  if (now.force() > contact.peak_force && !now.is_pushed()) contact.obstacle = now.obstacle;
  if (clamps_) return;
  clamps_ = !pending_clamping_.empty();
  if (clamps_) {
    contact.body = pending_clamping_;
    contact.is_push = false;
  } else if (now.force() > contact.peak_force) {
    contact.is_push = now.is_pushed();
    contact.body = body_name(contact.is_push ? BodyId::platform() : BodyId::from_index(now.body));
  }
}

/// The peak counts against the transient limit, what lasts longer against the quasi-static one.
void ContactWatch::limit_force(ContactVerdict& contact) const {
  const bool peak_is_good = contact.peak_force <= limits_.transient;
  const bool rest_is_good = contact.lasting_force.value_or(0.0) <= limits_.quasi_static;
  contact.within_limit = peak_is_good && rest_is_good;
  contact.limit = peak_is_good && !rest_is_good ? limits_.quasi_static : limits_.transient;
  contact.limit_name = peak_is_good && !rest_is_good ? "quasi-static" : "transient";
}

}  // namespace flinch
