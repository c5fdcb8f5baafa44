#pragma once

namespace flinch {

class Diagram;
class Recorder;
class ShownRun;
struct SimulatedScenario;

/// The recorder that shows a served rig, whose diagram this is, in a browser.
Recorder& rig_recorder(ShownRun& shown, const Diagram& rig, const SimulatedScenario& scenario);

}  // namespace flinch
