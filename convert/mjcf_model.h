#pragma once

#include "convert/body_graph.h"
#include "convert/xml_tree.h"

namespace flinch {

/// The bodies and joints of an MJCF, `root` being its <mujoco>. The base is the world. `connect` is a point
/// that two bodies share, `weld` a frame; where the second has it follows from the positions of the file.
/// Driven are the joints of actuators. Throws SetupError naming element and line.
BodyGraph read_mjcf(const XmlElement& root);

}  // namespace flinch
