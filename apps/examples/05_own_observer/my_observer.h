#pragma once

#include <algorithm>

#include "diagrams/control_stages.h"
#include "systems/framework/system.h"

/// An observer of your own for the external wrench: it predicts the momentum p and corrects the prediction,
///   dp_e/dt = F_a - beta + F_e,   F_e = k (p - p_e),
/// so that F_e follows the external wrench with the time constant 1/k.
class MyObserver final : public flinch::System {
 public:
  struct Prediction {
    bool started = false;
    flinch::Time since{};        // the first tick
    flinch::PlatformVector p_e;  // at the next tick
    flinch::WrenchEstimate estimate;
  };

 private:
  flinch::State<Prediction> last_ = state<Prediction>("last");

 public:
  explicit MyObserver(double gain) : k_(gain) {}

  flinch::InputPort<flinch::Kinematics> kinematics = input<flinch::Kinematics>("kinematics");
  flinch::InputPort<flinch::Dynamics> dynamics = input<flinch::Dynamics>("dynamics");
  flinch::InputPort<flinch::DriveTorque> torque = input<flinch::DriveTorque>("torque");

 private:
  flinch::Intermediate<Prediction> next_ =
      intermediate<&MyObserver::predict>("next", clock, last_, kinematics, dynamics, torque);

 public:
  flinch::OutputPort<flinch::WrenchEstimate> wrench = output<&MyObserver::read>("wrench", next_);

 private:
  flinch::Update remember_ = keep(last_, next_);

  Prediction predict(flinch::Time now, const Prediction& last, const flinch::Kinematics& at,
                     const flinch::Dynamics& model, const flinch::DriveTorque& drives) const {
    if (!at.valid || !model.valid || !drives.valid) return {};  // begin anew
    const flinch::PlatformVector p = model.M_x * at.velocity;
    Prediction next = last;
    if (!last.started) next = {.started = true, .since = now, .p_e = p, .estimate = {}};
    const flinch::PlatformVector F_e = k_ * (p - next.p_e);
    const flinch::PlatformVector F_a = at.J_qa_x.transpose() * drives.torque;
    const flinch::PlatformVector beta = model.g_x + model.F_fr_x - model.C_x.transpose() * at.velocity;
    next.p_e += 1e-3 * (F_a - beta + F_e);
    next.estimate = {.acquired = drives.acquired,
                     .valid = flinch::to_seconds(now - next.since) > 5.0 / k_,
                     .wrench_in_base = F_e,
                     .drive_torque = at.J_x_qa.transpose() * F_e};
    return next;
  }
  flinch::WrenchEstimate read(const Prediction& next) const { return next.estimate; }

  double k_;
};

/// How it is added to the control path.
inline flinch::WrenchEstimator my_observer(double gain) {
  return {"my_observer", [gain](const flinch::StageContext& site, const flinch::AcceleratedPorts& given) {
            auto& block = site.builder.add<MyObserver>(site.name, gain);
            site.builder.connect(given.kinematics, block.kinematics);
            site.builder.connect(given.dynamics, block.dynamics);
            site.builder.connect(given.drive_torque, block.torque);
            return block.wrench;
          }};
}
