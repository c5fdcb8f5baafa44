#pragma once

#include <string>

#include "systems/framework/time.h"
#include "systems/robot/body_id.h"
#include "systems/robot/vectors.h"

namespace flinch {

/// Largest number of things that can be touched: each body, and the gap of each leg.
inline constexpr int max_contact_classes = max_bodies + max_dof;

/// One entry for each class of a robot's `ContactClasses`.
using ClassVector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, max_contact_classes, 1>;

/// What can be touched of a robot, as numbers: first a collision with each body, in the order of
/// `BodyId::index()`, then clamping in each leg, which is contact of both its links with one object.
class ContactClasses {
 public:
  constexpr ContactClasses(int bodies, int legs) : bodies_(bodies), legs_(legs) {}

  constexpr int count() const { return bodies_ + legs_; }
  constexpr int bodies() const { return bodies_; }
  constexpr int legs() const { return legs_; }

  static constexpr int collision(BodyId body) { return body.index(); }
  constexpr int clamping(int leg) const { return bodies_ + leg; }

  constexpr bool contains(int number) const { return number >= 0 && number < count(); }
  constexpr bool is_clamping(int number) const { return number >= bodies_ && number < count(); }
  /// The body of a collision.
  static constexpr BodyId body(int number) { return BodyId::from_index(number); }
  /// The leg that is clamped or whose link is touched, from 0; -1: the platform.
  constexpr int leg(int number) const {
    return is_clamping(number) ? number - bodies_ : BodyId::from_index(number).leg();
  }
  /// "platform", "leg1_link2", "leg1_clamping", as verdicts name them; "" for a number that it does not
  /// contain.
  std::string name(int number) const;

  friend constexpr bool operator==(const ContactClasses&, const ContactClasses&) = default;

 private:
  int bodies_;
  int legs_;
};

/// What a classifier says was touched.
struct ContactClassification {
  Time acquired{};        ///< of the readings that it tells of
  bool valid = false;     ///< There is something to classify. Otherwise nothing below means anything.
  bool accepted = false;  ///< Sure enough to act upon; otherwise rejected: the reaction is the safe one.
  int most_likely = -1;   ///< number in the robot's ContactClasses
  ClassVector probability;
  /// No single contact explains the wrench: several things touch the robot, or it is not as its model says.
  bool several_contacts = false;
  /// e^T S^-1 e of the contact that explains the wrench best: S is the wrench's covariance, e what is left of
  /// it. Above a limit there are `several_contacts`. Negative: this classifier does not look at it.
  double residual = -1.0;

  /// Of the most likely class; 0 where there is none.
  double confidence() const {
    return most_likely >= 0 && most_likely < probability.size() ? probability[most_likely] : 0.0;
  }

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("acquired", "ns", self.acquired);
    visit("valid", "", self.valid);
    visit("accepted", "", self.accepted);
    visit("most_likely", "", self.most_likely);
    visit("probability", "1", self.probability);
    visit("several_contacts", "", self.several_contacts);
    visit("residual", "1", self.residual);
  }
};

/// How well contact with each class explains a wrench, by the model of the robot alone. One entry a class.
struct ContactEvidence {
  Time acquired{};
  bool valid = false;
  /// ln of the likelihood of the wrench, summed over where, how strongly and with how much friction the class
  /// may be touched, as likely as its motion makes it. Very negative (-1e6) where it cannot be.
  ClassVector log_evidence;
  ClassVector residual;  ///< least e^T S^-1 e of any such contact, where the wrench misses it by e
  ClassVector location;  ///< of the most likely one: 0 to 1 along the axis of a link; of others 0
  ClassVector force;     ///< of that one [N]
  ClassVector approach;  ///< speed at which the surface there moves outwards [m/s]

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("acquired", "ns", self.acquired);
    visit("valid", "", self.valid);
    visit("log_evidence", "1", self.log_evidence);
    visit("residual", "1", self.residual);
    visit("location", "1", self.location);
    visit("force", "N", self.force);
    visit("approach", "m/s", self.approach);
  }
};

}  // namespace flinch
