#pragma once

namespace flinch {

/// Whether what has latched shall let go.
struct ResetCommand {
  bool reset = false;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("reset", "", self.reset);
  }
};

}  // namespace flinch
