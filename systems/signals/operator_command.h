#pragma once

namespace flinch {

/// The buttons of whoever supervises the robot, as they are held now.
struct OperatorCommand {
  bool start = false;  ///< begin the nominal motion from where the robot stands
  bool reset = false;  ///< end a reaction, leave zero gravity; at rest, clear the faults of the torque gate
  bool stop = false;   ///< come to rest: fault `operator_stop` of the torque gate, as long as it is down

  template <class Self, class Visit>
  static void fields(Self& self, Visit&& visit) {
    visit("start", "", self.start);
    visit("reset", "", self.reset);
    visit("stop", "", self.stop);
  }
};

}  // namespace flinch
