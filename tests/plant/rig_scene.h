#pragma once

#include <memory>

#include "plant/compliant_obstacle.h"
#include "plant/rig_settings.h"
#include "systems/robot/planar_rrr.h"
#include "systems/robot/planar_rrr_presets.h"

namespace flinch::test {

/// The planar robot of the papers.
inline std::shared_ptr<const PlanarRrr> individual_rig(RigFriction friction = RigFriction::none) {
  return std::make_shared<const PlanarRrr>(rig_robot(RigGeometry::individual, friction));
}

/// What is said of a post with a round outline of 4 cm.
inline ObstacleForm post_form(double x, double y, const ContactMaterial& material = {}) {
  ObstacleForm form;
  form.name = "post";
  form.position_in_base = {x, y, 0.0};
  form.material = material;
  return form;
}

inline std::shared_ptr<const Obstacle> fixed_post(double x, double y, const ContactMaterial& material = {}) {
  return std::make_shared<const FixedObstacle>(post_form(x, y, material));
}

inline std::shared_ptr<const Obstacle> compliant_post(double x, double y,
                                                      const ContactMaterial& material = {},
                                                      const CompliantMount& mount = {}) {
  return std::make_shared<const CompliantObstacle>(post_form(x, y, material), mount);
}

}  // namespace flinch::test
