#pragma once

namespace flinch {

/// Whether the nominal motion shall begin.
struct StartCommand {
  bool start = false;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("start", "", self.start);
  }
};

}  // namespace flinch
