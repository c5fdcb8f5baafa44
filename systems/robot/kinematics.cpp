#include "systems/robot/kinematics.h"

namespace flinch {

void set_unreachable(ConfigurationSpace space, const JointCounts& joints, Kinematics& out) noexcept {
  const int n = space.dimension();
  out = Kinematics();
  out.pose = space.origin();
  out.velocity.setZero(n);
  for (JointVector* vector : {&out.joints.active, &out.rates.active}) vector->setZero(joints.active);
  for (JointVector* vector : {&out.joints.passive, &out.rates.passive}) vector->setZero(joints.passive);
  for (JointVector* vector : {&out.joints.coupling, &out.rates.coupling}) vector->setZero(joints.coupling);
  for (PlatformMatrix* J : {&out.J_qa_x, &out.dJ_qa_x}) J->setZero(joints.active, n);
  for (PlatformMatrix* J : {&out.J_qp_x, &out.dJ_qp_x}) J->setZero(joints.passive, n);
  for (PlatformMatrix* J : {&out.J_qc_x, &out.dJ_qc_x}) J->setZero(joints.coupling, n);
  for (PlatformMatrix* J : {&out.J_x_qa, &out.dJ_x_qa}) J->setZero(n, joints.active);
  for (LegPoints& leg : out.legs) {
    for (CartesianVector* point : {&leg.base_joint, &leg.passive_joint, &leg.coupling_joint}) {
      point->setZero(space.translations());
    }
  }
}

// Zero times a finite number is zero, and nothing else is: one sum in place of many comparisons.
bool all_finite(const Kinematics& kinematics) noexcept {
  double sum = 0.0;
  for (const JointVector* v : {&kinematics.rates.active, &kinematics.rates.passive}) sum += 0.0 * v->sum();
  for (const PlatformMatrix* J : {&kinematics.dJ_qa_x, &kinematics.dJ_qp_x, &kinematics.dJ_x_qa}) {
    sum += 0.0 * J->sum();
  }
  return sum == 0.0;
}

}  // namespace flinch
