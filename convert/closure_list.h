#pragma once

#include <string>
#include <string_view>

#include "convert/body_graph.h"

namespace flinch {

/// Adds the pairs of frames that a YAML text says coincide, as public sets of closed models write them:
///
///   closed_loop: [[frame_a, frame_b], ...]   # links, or joints, whose moving side is meant
///   type: ['6d', ...]                        # of each: 6d holds the axes too, 3d the points; default 6d
///   name_mot: [joint, ...]                   # optional: the joints that are driven
///   zeros: {joint: 0.1}                      # optional: about where joints are at home [rad or m]
///
/// Other keys are left unread. Throws SetupError, with `file` and line.
void add_closures(std::string_view text, const std::string& file, BodyGraph& graph);

}  // namespace flinch
