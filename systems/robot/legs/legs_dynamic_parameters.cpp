#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "systems/robot/body_moments.h"
#include "systems/robot/decompositions.h"
#include "systems/robot/dynamic_parameters.h"
#include "systems/robot/legs/legs_robot.h"
#include "systems/robot/parameter_variants.h"

namespace flinch {
namespace {

constexpr double link_share = 0.2;      // of what is believed of a link
constexpr double platform_share = 0.5;  // of the platform, with what is mounted on it
constexpr double armature_share = 0.2;
constexpr JointFriction turning_belief{.viscous = 0.5, .coulomb = 1.0};
constexpr JointFriction turning_belief_of_passive{.viscous = 0.1, .coulomb = 0.1};
constexpr JointFriction sliding_belief{.viscous = 200.0, .coulomb = 20.0};
constexpr double unbounded_moment = -1e9;
constexpr double thinness = 0.01;  // of a body's trace, or in the plane of its inertia about the origin

constexpr int tried_states = 60;
constexpr double own_share = 0.01;     // of its effect: what of a parameter the others cannot stand for
constexpr double torque_share = 5e-4;  // of all torque: what an effect must amount to

/// What of a robot a parameter is.
struct Meaning {
  enum class Of { moment, mass, armature, viscous, coulomb };
  Of of = Of::moment;
  std::size_t body = 0;  ///< Of a moment or a mass: by its place in `bodies`.
  int moment = 0;
  JointOfLeg joint{};  ///< Of friction and armature: the first of those of one axis.
};

struct Candidate {
  DynamicParameter parameter;
  Meaning meaning;
};

/// A body with mass.
struct MovedBody {
  std::string path;                ///< Of its keys in a robot file.
  std::optional<JointOfLeg> link;  ///< None: the platform, with what it carries.
};

template <class Model>
auto& inertia_of(const MovedBody& body, Model& model) {
  return body.link ? model.legs[body.link->leg].chain.joints[body.link->joint].link : model.platform;
}

std::string path_of(const LegsModel& model, const JointOfLeg& joint) {
  return "legs[" + std::to_string(joint.leg) + "].joints[" +
         std::to_string(model.legs[joint.leg].chain.joints[joint.joint].described) + "]";
}

/// The platform, then links from the base outwards, leg by leg: what several can stand for is said of the
/// first.
std::vector<MovedBody> bodies_of(const LegsModel& model) {
  std::vector<MovedBody> bodies;
  if (model.platform.mass > 0.0) bodies.push_back({"platform", std::nullopt});
  for (std::size_t j = 0; j < max_leg_joints; ++j) {
    for (std::size_t i = 0; i < model.legs.size(); ++i) {
      const LegChain& chain = model.legs[i].chain;
      if (j >= chain.joints.size() || !(chain.joints[j].link.mass > 0.0)) continue;
      const JointOfLeg link{i, j};
      bodies.push_back({path_of(model, link) + ".link", link});
    }
  }
  return bodies;
}

/// The moments that motion of such a robot can feel.
std::vector<int> felt_moments(const LegsModel& model) {
  if (model.moves.planar) return {0, 1, 2, 6};
  return {0, 1, 2, 3, 4, 5, 6, 7, 8, 9};
}

/// Whether files give it without its thickness: it can be heavier as a whole, but each of its moments is on
/// the edge of what a body can have.
bool is_thin(const RigidBodyInertia& body, bool planar) {
  if (planar) return body.inertia(2, 2) < thinness * about_origin(body)(2, 2);
  const double trace = body.inertia.trace();
  const Eigen::Matrix3d second = 0.5 * trace * Eigen::Matrix3d::Identity() - body.inertia;
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(second, Eigen::EigenvaluesOnly).eigenvalues()[0] <
         thinness * trace;
}

/// Whether it is the first of its leg that moves with its coordinate: not one that follows another.
bool leads(const LegChain& chain, std::size_t joint) {
  return std::none_of(
      chain.joints.begin(), chain.joints.begin() + static_cast<std::ptrdiff_t>(joint),
      [&](const ChainJoint& before) { return before.coordinate == chain.joints[joint].coordinate; });
}

bool is_of_drive(const LegsModel& model, const JointOfLeg& joint) {
  return std::any_of(model.drives.begin(), model.drives.end(), [&](const ModelDrive& drive) {
    return std::any_of(drive.terms.begin(), drive.terms.end(), [&](const ModelDrive::Term& term) {
      return term.leg == joint.leg && term.joint == joint.joint;
    });
  });
}

void add_joints(const LegsModel& model, std::vector<Candidate>& candidates) {
  for (std::size_t i = 0; i < model.legs.size(); ++i) {
    const LegChain& chain = model.legs[i].chain;
    for (std::size_t j = 0; j < chain.joints.size(); ++j) {
      const ChainJoint& joint = chain.joints[j];
      const bool is_further_axis = j > 0 && chain.joints[j - 1].described == joint.described;
      if (!leads(chain, j) || is_further_axis) continue;
      const JointOfLeg place{i, j};
      const bool takes = is_of_drive(model, place);
      const JointFriction& belief = joint.slides ? sliding_belief
                                    : takes      ? turning_belief
                                                 : turning_belief_of_passive;
      const std::string at = path_of(model, place);
      const std::string friction = at + ".friction.";
      candidates.push_back({{friction + (joint.slides ? "viscous_Ns_per_m" : "viscous_Nms_per_rad"),
                             joint.slides ? "N s/m" : "Nm s/rad", joint.friction.viscous, belief.viscous, 0.0,
                             takes ? DriveLoss::viscous : DriveLoss::none},
                            {.of = Meaning::Of::viscous, .joint = place}});
      candidates.push_back(
          {{friction + (joint.slides ? "coulomb_N" : "coulomb_Nm"), joint.slides ? "N" : "Nm",
            joint.friction.coulomb, belief.coulomb, 0.0, takes ? DriveLoss::coulomb : DriveLoss::none},
           {.of = Meaning::Of::coulomb, .joint = place}});
      if (!(joint.armature > 0.0)) continue;
      candidates.push_back({{at + ".drive." + (joint.slides ? "armature_kg" : "armature_kg_m2"),
                             joint.slides ? "kg" : "kg m^2", joint.armature, armature_share * joint.armature},
                            {.of = Meaning::Of::armature, .joint = place}});
    }
  }
}

void add_bodies(const LegsModel& model, const std::vector<MovedBody>& bodies,
                std::vector<Candidate>& candidates) {
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    const RigidBodyInertia& body = inertia_of(bodies[b], model);
    const BodyMoments moments = moments_of(body);
    const double share = bodies[b].link ? link_share : platform_share;
    if (is_thin(body, model.moves.planar)) {
      candidates.push_back({{bodies[b].path + ".mass", "kg", body.mass, share * body.mass},
                            {.of = Meaning::Of::mass, .body = b}});
      continue;
    }
    // Half the trace of the inertia about the origin is mass times a mean square of distances.
    const double reach = std::sqrt(0.5 * about_origin(body).trace() / body.mass);
    for (const int k : felt_moments(model)) {
      const double size = body.mass * (k == 0 ? 1.0 : k < 4 ? reach : reach * reach);
      if (!(size > 0.0)) continue;
      const bool is_positive = k == 0 || (k >= 4 && k < 7);
      candidates.push_back({{bodies[b].path + "." + moment_name(k), moment_unit(k), moments[k], share * size,
                             is_positive ? 0.0 : unbounded_moment},
                            {.of = Meaning::Of::moment, .body = b, .moment = k}});
    }
  }
}

class LegsDynamicParameters final : public DynamicParameters {
 public:
  LegsDynamicParameters(std::shared_ptr<const LegsRobot> robot, std::vector<MovedBody> bodies,
                        const std::vector<Candidate>& candidates)
      : robot_(std::move(robot)), bodies_(std::move(bodies)) {
    for (const Candidate& candidate : candidates) {
      list_.push_back(candidate.parameter);
      meanings_.push_back(candidate.meaning);
    }
  }

  std::shared_ptr<const ParallelRobot> with(const Eigen::VectorXd& values) const override {
    LegsModel model = robot_->model();
    for (std::size_t b = 0; b < bodies_.size(); ++b) {
      if (!places_of(b).empty()) inertia_of(bodies_[b], model) = body_of(moments(b, values));
    }
    for (std::size_t i = 0; i < meanings_.size(); ++i)
      set(meanings_[i], values[static_cast<Eigen::Index>(i)], model);
    return robot_->with(std::move(model));
  }

  std::vector<Eigen::MatrixXd> must_be_definite(const Eigen::VectorXd& values) const override {
    std::vector<Eigen::MatrixXd> matrices;
    for (std::size_t b = 0; b < bodies_.size(); ++b) {
      const std::vector<int> places = places_of(b);
      if (places.empty() || meanings_[static_cast<std::size_t>(places[0])].of == Meaning::Of::mass) continue;
      const BodyMoments now = moments(b, values);
      const bool planar = robot_->model().moves.planar;
      matrices.push_back(planar ? Eigen::MatrixXd(planar_pseudo_inertia(now))
                                : Eigen::MatrixXd(pseudo_inertia(now)));
    }
    return matrices;
  }

  // A robot file tells of the platform without what it carries.
  std::vector<FileValue> in_file(const Eigen::VectorXd& values) const override {
    std::vector<FileValue> told;
    for (std::size_t i = 0; i < meanings_.size(); ++i) {
      const auto index = static_cast<int>(i);
      if (!is_of_body(meanings_[i])) told.push_back({list_[i].name, list_[i].unit, values[index], {index}});
    }
    for (std::size_t b = 0; b < bodies_.size(); ++b) {
      const std::vector<int> mainly = places_of(b);
      if (mainly.empty()) continue;
      const LegsModel& model = robot_->model();
      BodyMoments alone = moments(b, values);
      if (!bodies_[b].link && model.payload.mass > 0.0) alone -= moments_of(model.payload);
      for (FileValue& value : body_in_file(bodies_[b].path, described(b, body_of(alone)))) {
        value.mainly = mainly;
        told.push_back(std::move(value));
      }
    }
    return told;
  }

 private:
  static bool is_of_body(const Meaning& meaning) {
    return meaning.of == Meaning::Of::moment || meaning.of == Meaning::Of::mass;
  }
  /// In the list, of the moments of a body, or its mass.
  std::vector<int> places_of(std::size_t body) const {
    std::vector<int> places;
    for (std::size_t i = 0; i < meanings_.size(); ++i) {
      if (is_of_body(meanings_[i]) && meanings_[i].body == body) places.push_back(static_cast<int>(i));
    }
    return places;
  }
  /// As a file describes it: moments that motion in the plane does not feel stay in proportion.
  RigidBodyInertia described(std::size_t body, const RigidBodyInertia& found) const {
    if (!robot_->model().moves.planar) return found;
    RigidBodyInertia planar = inertia_of(bodies_[body], robot_->model());
    planar.mass = found.mass;
    planar.centre_of_mass.head<2>() = found.centre_of_mass.head<2>();
    if (planar.inertia(2, 2) > 0.0) planar.inertia *= found.inertia(2, 2) / planar.inertia(2, 2);
    planar.inertia(2, 2) = found.inertia(2, 2);
    return planar;
  }
  BodyMoments moments(std::size_t body, const Eigen::VectorXd& values) const {
    BodyMoments moments = moments_of(inertia_of(bodies_[body], robot_->model()));
    for (const int place : places_of(body)) {
      const Meaning& meaning = meanings_[static_cast<std::size_t>(place)];
      if (meaning.of == Meaning::Of::mass) return moments * (values[place] / moments[0]);
      moments[meaning.moment] = values[place];
    }
    return moments;
  }
  /// Friction is that of all axes of a joint.
  static void set(const Meaning& meaning, double value, LegsModel& model) {
    if (is_of_body(meaning)) return;
    LegChain& chain = model.legs[meaning.joint.leg].chain;
    const int described = chain.joints[meaning.joint.joint].described;
    if (meaning.of == Meaning::Of::armature) {
      chain.joints[meaning.joint.joint].armature = value;
      return;
    }
    for (std::size_t j = meaning.joint.joint; j < chain.joints.size(); ++j) {
      if (chain.joints[j].described != described || !leads(chain, j)) continue;
      JointFriction& friction = chain.joints[j].friction;
      (meaning.of == Meaning::Of::viscous ? friction.viscous : friction.coulomb) = value;
    }
  }

  std::shared_ptr<const LegsRobot> robot_;
  std::vector<MovedBody> bodies_;
  std::vector<Meaning> meanings_;
};

/// Evenly spread over (-1, 1): the multiples of a root of a prime, without what is whole.
double spread(int number, int dimension) {
  static constexpr std::array primes = {2.0,  3.0,  5.0,  7.0,  11.0, 13.0, 17.0, 19.0, 23.0,
                                        29.0, 31.0, 37.0, 41.0, 43.0, 47.0, 53.0, 59.0, 61.0};
  const double multiple = number * std::sqrt(primes[static_cast<std::size_t>(dimension) % primes.size()]);
  return 2.0 * (multiple - std::floor(multiple)) - 1.0;
}

/// What parameters do to the drives in motions about home: rows of all drives, columns by deviation of their
/// belief; and the torque.
struct Effects {
  Eigen::MatrixXd of_parameters;
  Eigen::VectorXd torque;
};

Effects effects_about_home(const LegsRobot& robot, const DynamicParameters& parameters) {
  const ParameterVariants variants(parameters);
  const int n = robot.dof();
  const int translations = robot.space().translations();
  const double length = robot.model().characteristic_length;
  Effects effects;
  effects.of_parameters.setZero(tried_states * robot.drives(), static_cast<Eigen::Index>(variants.size()));
  effects.torque.setZero(tried_states * robot.drives());
  for (int state = 0; state < tried_states; ++state) {
    PlatformVector away(n), velocity(n), acceleration(n);
    for (int i = 0; i < n; ++i) {
      const double scale = i < translations ? length : 1.0;
      away[i] = 0.25 * scale * spread(state + 1, i);
      velocity[i] = 3.0 * scale * spread(state + 1, n + i);
      acceleration[i] = 30.0 * scale * spread(state + 1, 2 * n + i);
    }
    Kinematics at;
    robot.kinematics(robot.space().plus(robot.home_pose(), away), velocity, at);
    if (!at.valid) continue;
    const JointVector torque = model_effort(robot, at, acceleration);
    effects.torque.segment(state * robot.drives(), robot.drives()) = torque;
    effects.of_parameters.middleRows(state * robot.drives(), robot.drives()) =
        variants.regressor(torque, at, acceleration);
  }
  for (Eigen::Index j = 0; j < effects.of_parameters.cols(); ++j)
    effects.of_parameters.col(j) *= parameters.list()[static_cast<std::size_t>(j)].deviation;
  return effects;
}

/// Those that no motion can show by what others do, base parameters as Gautier (IEEE Trans. Robotics and
/// Automation 7(3), 1991) has them: each candidate whose effect is not a sum of those before it. The rest
/// stays as believed.
std::vector<Candidate> independent(const std::vector<Candidate>& candidates, const Effects& effects) {
  std::vector<Candidate> kept;
  Eigen::MatrixXd basis(effects.torque.size(), 0);
  for (std::size_t j = 0; j < candidates.size(); ++j) {
    const Eigen::VectorXd effect = effects.of_parameters.col(static_cast<Eigen::Index>(j));
    Eigen::VectorXd left = effect;
    for (int pass = 0; pass < 2; ++pass) left -= basis * (basis.transpose() * left);
    if (left.norm() < std::max(own_share * effect.norm(), torque_share * effects.torque.norm())) continue;
    if (!(left.norm() > 0.0)) continue;
    basis.conservativeResize(Eigen::NoChange, basis.cols() + 1);
    basis.rightCols<1>() = left.normalized();
    kept.push_back(candidates[j]);
  }
  return kept;
}

}  // namespace

std::unique_ptr<const DynamicParameters> LegsRobot::dynamic_parameters() const {
  const std::vector<MovedBody> bodies = bodies_of(model_);
  std::vector<Candidate> candidates;
  add_joints(model_, candidates);
  add_bodies(model_, bodies, candidates);
  const std::shared_ptr<const LegsRobot> robot = with(model_);
  const LegsDynamicParameters all(robot, bodies, candidates);
  return std::make_unique<const LegsDynamicParameters>(
      robot, bodies, independent(candidates, effects_about_home(*this, all)));
}

}  // namespace flinch
