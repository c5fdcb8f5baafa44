#pragma once

namespace flinch {

class ConfigReader;
struct ControlStages;

/// Reads from the section `control` of a scenario which of `stages`, all that can be named, shall run and
/// which shall be followed. Without a word the first of each kind does, and no source of acceleration.
void read_stages(ConfigReader& control, ControlStages& stages);

}  // namespace flinch
