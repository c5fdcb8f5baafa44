#pragma once

#include "systems/signals/contact_classes.h"

namespace flinch {

/// What of a recorded classification is looked at, whichever version recorded it.
struct RecordedClassification {
  bool valid = false;
  bool accepted = false;
  int most_likely = -1;
  ClassVector probability;
  bool several_contacts = false;

  /// Of the most likely class; 0 where there is none.
  double confidence() const {
    return most_likely >= 0 && most_likely < probability.size() ? probability[most_likely] : 0.0;
  }

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("valid", "", self.valid);
    visit("accepted", "", self.accepted);
    visit("most_likely", "", self.most_likely);
    visit("probability", "1", self.probability);
    visit("several_contacts", "", self.several_contacts);
  }
};

/// What tells of a classifier that it looks whether several things touch; older recordings lack it.
struct RecordedResidual {
  double residual = -1.0;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("residual", "1", self.residual);
  }
};

}  // namespace flinch
