#pragma once

#include <vector>

#include "systems/framework/time.h"
#include "systems/robot/mechanism.h"
#include "systems/robot/vectors.h"
#include "systems/signals/friction_interval.h"

namespace flinch {

/// When the dry friction of a drive is not known but for its bounds, and how wide these are.
struct FrictionBoundsSettings {
  double share = 1.5;        ///< Of the model's dry friction, that a drive may have at most.
  double slow = 3.0;         ///< Below this many rates over which the model rounds friction, it may stick.
  double turns = 0.6;        ///< Above this many it has a direction, which it may turn round.
  double presliding = 4e-3;  ///< Way after turning round until friction is that of sliding [rad].
  double sliding_presliding = 5e-4;  ///< Likewise, of drives that slide [m].
  Time closing = 4ms;                ///< Time constant with which the interval closes once a drive is fast.
};

/// What is remembered of how drives came to rest; one entry a drive.
struct FrictionBoundsMemory {
  bool started = false;
  Time acquired{};
  JointVector open;       ///< How far the interval is, 0 to 1.
  JointVector direction;  ///< Of its last motion, 1 or -1; 0: none yet.
  JointVector gone;       ///< Since it turned round [rad or m].
};

/// Near rest a drive's dry friction takes any value up to its largest: it balances whatever torque there is.
/// So an estimator that believes in a law of friction sees an effort from outside that is none, by up to f -
/// share F to f + share F, where f is the friction that the law gives and F its largest. The interval is
/// open below some rate, closes in some milliseconds above it, and is open once more from where a drive has
/// turned round until it has gone some way, over which friction builds up. (Derived.)
class FrictionBounds {
 public:
  FrictionBounds(const Mechanism& robot, const FrictionBoundsSettings& settings);

  /// Takes in the rates of the drives at a later time.
  void follow(Time acquired, const JointVector& rate, const FrictionBoundsMemory& memory,
              FrictionBoundsMemory& next) const;
  FrictionInterval interval(const JointVector& rate, const FrictionBoundsMemory& memory) const;

 private:
  struct Drive {
    DryFriction friction;
    double presliding;
  };
  std::vector<Drive> drives_;
  FrictionBoundsSettings settings_;
};

}  // namespace flinch
