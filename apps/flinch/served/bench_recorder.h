#pragma once

namespace flinch {

class Diagram;
class Recorder;
class ShownRun;
struct SimulatedScenario;

/// The recorder that shows a served bench, whose diagram this is, in a browser.
Recorder& bench_recorder(ShownRun& shown, const Diagram& bench, const SimulatedScenario& scenario);

}  // namespace flinch
