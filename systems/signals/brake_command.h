#pragma once

namespace flinch {

/// Whether the brakes shall close. The default closes them.
struct BrakeCommand {
  bool engage = true;

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("engage", "", self.engage);
  }
};

}  // namespace flinch
