#include "experiments/verdict/contact_monitor.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "systems/robot/body_id.h"

namespace flinch {

namespace {

const RunLoad* load_of(int obstacle, const RunSample& now) {
  const auto found = std::find_if(now.loads.begin(), now.loads.end(),
                                  [obstacle](const RunLoad& load) { return load.obstacle == obstacle; });
  return found == now.loads.end() ? nullptr : &*found;
}

}  // namespace

void ContactMonitor::see(const RunSample& now, double period) {
  for (const RunLoad& load : now.loads) see(load, now, period);
  for (Watched& contact : contacts_) {
    if (!contact.lasts(now.time)) continue;
    note_detections(now, contact);
    note_classification(now, contact);
    note_located(now, contact);
    note_braking(now, contact.seen);
    note_task(now, contact.seen);
  }
  before_ = now;
}

void ContactMonitor::see(const RunLoad& load, const RunSample& now, double period) {
  const bool touches = load.load() > 1.0;
  Watched* contact = contact_of(load, now.time);
  if (contact == nullptr && touches) contact = &begin(load, now);
  if (contact == nullptr) return;
  if (contact->pending_clamping.empty() && load.clamped_leg >= 0)
    contact->pending_clamping = "leg" + std::to_string(load.clamped_leg + 1) + "_clamping";
  if (touches) extend(load, now, period, *contact);
}

/// The one with the obstacle that lasts; a push goes on with any that does, and an obstacle with a push.
ContactMonitor::Watched* ContactMonitor::contact_of(const RunLoad& load, double time) {
  const auto find = [&](const auto& wanted) {
    const auto found = std::find_if(contacts_.rbegin(), contacts_.rend(), [&](const Watched& contact) {
      return contact.lasts(time) && wanted(contact);
    });
    return found == contacts_.rend() ? nullptr : &*found;
  };
  if (load.obstacle < 0) return find([](const Watched&) { return true; });
  Watched* const same = find([&](const Watched& contact) { return contact.obstacle == load.obstacle; });
  return same != nullptr ? same : find([](const Watched& contact) { return contact.obstacle < 0; });
}

/// By the present levels; a latched one would not do: of a second contact it knows nothing. Who has detected
/// something before there was a contact detects this one only after having let go of that.
void ContactMonitor::note_detections(const RunSample& now, Watched& of) const {
  ContactVerdict& contact = of.seen;
  for (std::size_t i = 0; i < contact.detected_by.size() && i < now.detected_by.size(); ++i) {
    if (i < of.alarmed.size() && of.alarmed[i]) {
      of.alarmed[i] = now.detected_by[i];
      continue;
    }
    std::optional<double>& detected = contact.detected_by[i].detected;
    if (now.detected_by[i] && !detected) detected = now.time;
  }
  if (!contact.detected_by.empty()) contact.detected = contact.detected_by.front().detected;
}

void ContactMonitor::note_classification(const RunSample& now, Watched& of) const {
  ContactVerdict& contact = of.seen;
  if (!contact.detected) return;
  if (now.several_contacts) contact.several_contacts = now.several_contacts;
  if (now.classified.empty() || contact.classified_at) return;
  contact.classified = now.classified;
  contact.classified_at = now.time;
  contact.probability = now.probability;
  const RunLoad* const load = load_of(of.obstacle, now);
  const ContactLocation& found = now.location;
  if (!now.is_true || load == nullptr || load->pushes() || !found.valid || !found.located) return;
  if (found.point_in_base.size() != load->touched_point.size() || load->touched_point.size() == 0) return;
  contact.location_error = (found.point_in_base - load->touched_point).norm();
  contact.force_error = (found.force_in_base - load->touched_force).norm();
}

void ContactMonitor::note_located(const RunSample& now, Watched& of) const {
  ContactVerdict& contact = of.seen;
  if (contact.contacts_located || !now.located.valid || !contact.detected) return;
  if (now.time < *contact.detected + LocatedContacts::settled) return;
  const RunLoad* const load = load_of(of.obstacle, now);
  if (!now.is_true || load == nullptr || load->pushes() || load->touched_point.size() == 0) return;
  contact.contacts_located = now.located.count;
  for (int i = 0; i < now.located.count; ++i) {
    const CartesianVector& point = now.located.contacts[static_cast<std::size_t>(i)].point_in_base;
    if (point.size() != load->touched_point.size()) continue;
    const double error = (point - load->touched_point).norm();
    if (!contact.base_location_error || error < *contact.base_location_error)
      contact.base_location_error = error;
  }
}

void ContactMonitor::note_braking(const RunSample& now, ContactVerdict& contact) const {
  const BrakingStatus& found = now.braking;
  if (contact.could_stop || !found.valid || to_seconds(found.judged) < contact.onset) return;
  contact.could_stop = found.stays_inside;
  if (std::isfinite(found.duration)) contact.stop_duration = found.duration;
}

void ContactMonitor::note_task(const RunSample& now, ContactVerdict& contact) const {
  if (!now.task.valid || !contact.detected || now.mode == ReactionMode::hold) return;
  std::vector<TaskBegin>& tasks = contact.reaction_tasks;
  if (tasks.empty() || tasks.back().task != now.task) tasks.push_back({now.task, now.time});
}

std::vector<ContactVerdict> ContactMonitor::contacts() const {
  std::vector<ContactVerdict> judged;
  for (const Watched& contact : contacts_) {
    judged.push_back(contact.seen);
    if (contact.lasts(before_->time)) judged.back().removed.reset();
    limit_force(judged.back());
  }
  std::stable_sort(judged.begin(), judged.end(), [](const ContactVerdict& first, const ContactVerdict& then) {
    return first.onset < then.onset;
  });
  return judged;
}

/// When the load rose above that of a contact: between the sample before and this one.
ContactMonitor::Watched& ContactMonitor::begin(const RunLoad& load, const RunSample& now) {
  ContactVerdict contact;
  contact.onset = now.time;
  contact.speed = now.speed;
  const double before = load_before(load.obstacle);
  if (!std::isnan(before)) {
    const double share = (1.0 - before) / (load.load() - before);
    contact.onset = before_->time + share * (now.time - before_->time);
    contact.speed = before_->speed + share * (now.speed - before_->speed);
  }
  contact.peak_force = -1.0;
  for (const std::string& estimator : estimators_) contact.detected_by.push_back({estimator, std::nullopt});
  Watched watched{.seen = std::move(contact), .last = now.time};
  const bool is_first = std::none_of(contacts_.begin(), contacts_.end(),
                                     [&now](const Watched& other) { return other.lasts(now.time); });
  if (is_first && before_) watched.alarmed = before_->detected_by;
  return contacts_.emplace_back(std::move(watched));
}

/// At the sample before, at most 1; of a push where no obstacle touched. Not a number where nobody knows.
double ContactMonitor::load_before(int obstacle) const {
  if (!before_) return std::nan("");
  const RunLoad* const same = load_of(obstacle, *before_);
  if (same != nullptr) return same->load();
  const RunLoad& hardest = before_->loads.front();
  return hardest.obstacle < 0 ? std::min(hardest.load(), 1.0) : 0.0;
}

void ContactMonitor::extend(const RunLoad& load, const RunSample& now, double period, Watched& of) const {
  ContactVerdict& contact = of.seen;
  of.last = now.time;
  if (load.obstacle >= 0) of.obstacle = load.obstacle;
  contact.removed = now.time + period;
  const bool lasts = now.time - contact.onset > limits_.transient_duration;
  if (lasts) {
    contact.lasting_force = std::max(contact.lasting_force.value_or(0.0), load.force());
  }
  if (load.force() > (lasts ? limits_.quasi_static : limits_.transient)) contact.over_limit += period;
  name_body(load, now, of);
  if (load.force() > contact.peak_force) {
    contact.peak_force = load.force();
    contact.peak_time = now.time;
  }
  of.pending_clamping.clear();
}

/// A leg's clamping where that happens during the contact, else the body with the peak force.
void ContactMonitor::name_body(const RunLoad& load, const RunSample& now, Watched& of) const {
  ContactVerdict& contact = of.seen;
  const bool is_hardest = load.force() > contact.peak_force;
  const auto place = static_cast<std::size_t>(load.obstacle);
  if (is_hardest && !(now.is_true && load.pushes())) {
    contact.obstacle = load.obstacle;
    contact.obstacle_name = place < obstacles_.size() ? obstacles_[place] : "";
  }
  if (!now.is_true || of.clamps) return;
  of.clamps = !of.pending_clamping.empty();
  if (of.clamps) {
    contact.body = of.pending_clamping;
    contact.is_push = false;
  } else if (is_hardest) {
    contact.is_push = load.pushes();
    contact.body = body_name(contact.is_push ? BodyId::platform() : BodyId::from_index(load.body));
  }
}

/// The peak counts against the transient limit, what lasts longer against the quasi-static one.
void ContactMonitor::limit_force(ContactVerdict& contact) const {
  const bool peak_is_good = contact.peak_force <= limits_.transient;
  const bool rest_is_good = contact.lasting_force.value_or(0.0) <= limits_.quasi_static;
  contact.within_limit = peak_is_good && rest_is_good;
  contact.limit = peak_is_good && !rest_is_good ? limits_.quasi_static : limits_.transient;
  contact.limit_name = peak_is_good && !rest_is_good ? "quasi-static" : "transient";
}

}  // namespace flinch
