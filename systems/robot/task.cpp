#include "systems/robot/task.h"

namespace flinch {

Task no_task(int rows, int dof) noexcept {
  return {PlatformVector::Zero(rows), PlatformMatrix::Zero(rows, dof), PlatformVector::Zero(rows), false};
}

Task along(const Task& task, const PlatformVector& direction) noexcept {
  if (direction.size() != task.rows()) return no_task(1, static_cast<int>(task.J.cols()));
  return {direction.transpose() * task.sigma, direction.transpose() * task.J,
          direction.transpose() * task.drift, task.valid};
}

Task stacked(const Task& first, const Task& second) noexcept {
  const int rows = first.rows() + second.rows();
  if (rows > max_dof || first.J.cols() != second.J.cols()) return no_task(first.rows(), first.rows());
  Task both = no_task(rows, static_cast<int>(first.J.cols()));
  both.sigma << first.sigma, second.sigma;
  both.J << first.J, second.J;
  both.drift << first.drift, second.drift;
  both.valid = first.valid && second.valid;
  return both;
}

DriveTask seen_by_drives(const Task& task, const Kinematics& kinematics) noexcept {
  const int drives = drive_count(kinematics);
  DriveTask seen{PlatformMatrix::Zero(task.rows(), drives), PlatformVector::Zero(task.rows()), false};
  if (!task.valid || !kinematics.valid) return seen;
  seen.J = task.J * kinematics.J_x_qa;
  seen.drift = task.J * (kinematics.dJ_x_qa * kinematics.rates.active) + task.drift;
  seen.valid = true;
  return seen;
}

}  // namespace flinch
