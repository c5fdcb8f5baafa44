#pragma once

namespace flinch {

/// The two buttons of whoever supervises the robot, as they are held now.
struct OperatorCommand {
  bool start = false;  ///< begin the nominal motion from where the robot stands
  bool reset = false;  ///< end a reaction, leave zero gravity, clear the faults of the torque gate

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("start", "", self.start);
    visit("reset", "", self.reset);
  }
};

}  // namespace flinch
