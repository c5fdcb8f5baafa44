#pragma once

#include "convert/body_graph.h"
#include "convert/xml_tree.h"

namespace flinch {

/// The links and joints of the model of an SDF, `root` being its <sdf>. Joints may close loops. The base is
/// the world where joints lead to it, otherwise the first link. Throws SetupError with element and line.
BodyGraph read_sdf(const XmlElement& root);

}  // namespace flinch
