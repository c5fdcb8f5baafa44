#pragma once

#include "convert/body_graph.h"
#include "convert/xml_tree.h"

namespace flinch {

/// URDF wants a range of each joint that slides: one as wide as this either way, or wider, is none [m].
inline constexpr double unlimited_slide = 10.0;

/// The links and joints of a URDF, `root` being its <robot>. The base is the link that is no child. Driven
/// are the joints that its transmissions name. Throws SetupError naming element and line.
BodyGraph read_urdf(const XmlElement& root);

/// Pose of origins as URDF and SDF write them: a translation, and turns about fixed x, y and z [rad].
Eigen::Isometry3d pose_of(const Eigen::Vector3d& xyz, const Eigen::Vector3d& rpy);

}  // namespace flinch
