#pragma once

#include "systems/robot/body_id.h"
#include "systems/robot/mechanism.h"
#include "systems/robot/task.h"

/// Tasks by which a robot gives way to a contact, [SafePR] (24)-(31), and by which it moves. All of them are
/// valid where the kinematics is reachable and what they ask for exists.
namespace flinch {

/// sigma = x_t: position of the platform in the base frame [m]. (26); along a direction (27)
Task platform_position_task(const Mechanism& mechanism, const Kinematics& kinematics) noexcept;

/// Position and orientation of the platform. Rows as in a velocity; the rows of the orientation are the
/// rotation vector from the base frame [rad], so that differences of them mean nothing but for planar robots.
Task platform_pose_task(const Mechanism& mechanism, const Kinematics& kinematics) noexcept;

/// The orientation's rows of that task, to be held below the position. No rows where the platform cannot
/// turn, and then not valid.
Task platform_orientation_task(const Mechanism& mechanism, const Kinematics& kinematics) noexcept;

/// sigma = q_a,j: position of a drive [rad or m]. (28)
Task drive_task(const Kinematics& kinematics, int drive) noexcept;

/// sigma = q_p,j: angle of a passive joint [rad]. With `drive_task` of the leg it opens the structure. (31)
Task passive_joint_task(const Kinematics& kinematics, int joint) noexcept;

/// sigma = x_c,t: position of a point of a body, given in body coordinates, in the base frame [m]. (29);
/// along a direction (30)
Task point_task(const Mechanism& mechanism, const Kinematics& kinematics, BodyId body,
                const CartesianVector& point_in_body) noexcept;

/// Distance of the platform from `centre` [m]. In the centre itself it has no gradient: zero.
Task radius_task(const Mechanism& mechanism, const Kinematics& kinematics,
                 const CartesianVector& centre) noexcept;

}  // namespace flinch
