#include "experiments/report/report_samples.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "experiments/report/classification_timeline.h"
#include "experiments/report/constraint_lane.h"
#include "experiments/report/drawn_robot.h"
#include "experiments/report/limit_lane.h"
#include "experiments/report/operator_lane.h"
#include "experiments/report/page_samples.h"
#include "experiments/report/reaction_lane.h"
#include "experiments/report/station_lanes.h"
#include "experiments/report/task_energy_columns.h"
#include "experiments/report/vector_columns.h"
#include "experiments/verdict/recorded_classification.h"
#include "experiments/verdict/recorded_estimate.h"
#include "experiments/verdict/recorded_run.h"
#include "experiments/verdict/recorded_truth.h"
#include "systems/framework/recorded_values.h"
#include "systems/robot/parallel_robot.h"
#include "systems/signals/contact_classes.h"
#include "systems/signals/contact_location.h"
#include "systems/signals/particle_cloud.h"
#include "systems/signals/platform_motion.h"
#include "systems/signals/platform_reference.h"
#include "systems/signals/torque_command.h"
#include "systems/signals/workspace_measures.h"
#include "systems/signals/wrench_estimate.h"

namespace flinch {
namespace {

/// What of a sample only a simulation knows.
struct Truth {
  RecordedTruth robot;
  RecordedContact contact;
};

class RecordedTruths {
 public:
  explicit RecordedTruths(const Recording& recording)
      : robot_(recording, "truth"), contact_(recording, "contact") {}
  Truth operator[](std::size_t sample) const { return {robot_[sample], contact_[sample]}; }

 private:
  RecordedValues<RecordedTruth> robot_;
  RecordedValues<RecordedContact> contact_;
};

/// The platform as it truly was, or as the controller took it to be.
class Motion {
 public:
  Motion(const ParallelRobot& robot, const Recording& recording, bool simulated, PageSamples& page)
      : space_(robot.space()),
        reference_(recording, "reference"),
        pose_(page, pose_names(space_)),
        speed_(page.column("speed")),
        position_error_(page.column("position_error")),
        page_(page) {
    if (space_.rotations() > 0) orientation_error_ = page.column("orientation_error");
    if (!simulated) measured_.emplace(recording, "motion");
  }

  void show(std::size_t sample, const Truth* truth, double hardness) {
    if (truth != nullptr) return show(truth->robot.pose, truth->robot.velocity, sample, hardness);
    const PlatformMotion now = (*measured_)[sample];
    show(now.pose, now.velocity, sample, hardness);
  }

 private:
  void show(const Configuration& pose, const PlatformVector& velocity, std::size_t sample, double hardness) {
    pose_.set(pose, hardness);
    const bool moves = velocity.size() == space_.dimension();
    page_.set(speed_, moves ? velocity.head(space_.translations()).norm() : no_value);
    const PlatformReference wanted = reference_[sample];
    const bool followed = wanted.valid && space_.contains(pose) && space_.contains(wanted.pose);
    const PlatformVector error =
        followed ? space_.difference(pose, wanted.pose) : PlatformVector::Zero(space_.dimension());
    page_.set(position_error_, followed ? error.head(space_.translations()).norm() : no_value);
    if (orientation_error_)
      page_.set(*orientation_error_, followed ? error.tail(space_.rotations()).norm() : no_value);
  }

  ConfigurationSpace space_;
  std::optional<RecordedValues<PlatformMotion>> measured_;
  RecordedValues<PlatformReference> reference_;
  VectorColumns pose_;
  std::size_t speed_, position_error_;
  std::optional<std::size_t> orientation_error_;
  PageSamples& page_;
};

/// Forces on the platform, estimated and true, and where the two hardest contacts touch.
class Forces {
 public:
  Forces(const ParallelRobot& robot, const Recording& recording, bool simulated, PageSamples& page)
      : translations_(robot.space().translations()),
        wrench_(recording, "wrench"),
        estimate_(page, wrench_names("estimated", robot.space())) {
    if (!simulated) return;
    external_.emplace(page, wrench_names("external", robot.space()));
    for (const std::string contact : {"contact_1_", "contact_2_"}) {
      touches_.push_back({VectorColumns(page, named(contact, translations_)),
                          VectorColumns(page, named(contact + "force_", translations_))});
    }
  }

  void show(std::size_t sample, const Truth* truth, double hardness) {
    const WrenchEstimate estimate = wrench_[sample];
    if (estimate.valid) {
      estimate_.set(estimate.wrench_in_base, strength(estimate.wrench_in_base));
    } else {
      estimate_.set_no_data();
    }
    if (truth == nullptr) return;
    external_->set(truth->robot.wrench_in_base, strength(truth->robot.wrench_in_base));
    show(truth->contact.strongest, hardness, touches_[0]);
    show(truth->contact.second, hardness, touches_[1]);
  }

 private:
  struct Touch {
    VectorColumns point, force;
  };

  /// A contact point is only shown while its body is touched.
  static void show(const RecordedTouch& touch, double hardness, Touch& columns) {
    const CartesianVector nothing = CartesianVector::Constant(touch.point_in_base.size(), no_value);
    columns.point.set(touch.body >= 0 ? touch.point_in_base : nothing, hardness);
    columns.force.set(touch.body >= 0 ? touch.force_in_base : nothing, hardness);
  }
  double strength(const PlatformVector& wrench) const {
    return wrench.size() < translations_ ? no_value : wrench.head(translations_).norm();
  }

  int translations_;
  RecordedValues<WrenchEstimate> wrench_;
  VectorColumns estimate_;
  std::optional<VectorColumns> external_;
  std::vector<Touch> touches_;
};

/// What each estimator says acts on the platform, where several run: magnitudes.
class EstimatesSideBySide {
 public:
  EstimatesSideBySide(ConfigurationSpace space, const Recording& recording, PageSamples& page, Report& report)
      : space_(space), page_(page) {
    const std::string prefix = "wrench_";
    std::vector<std::string> paths = {"wrench"};
    const auto followed = recording.attributes.find("control.estimator");
    std::vector<std::string> names = {followed == recording.attributes.end() ? "followed" : followed->second};
    for (const Signal& signal : recording.signals) {
      if (!signal.path.starts_with(prefix)) continue;
      paths.push_back(signal.path);
      names.push_back(signal.path.substr(prefix.size()));
    }
    if (paths.size() < 2) return;
    report.estimators = names;
    for (std::size_t i = 0; i < paths.size(); ++i) {
      const std::string column = "estimator_" + std::to_string(i + 1);
      estimates_.push_back({RecordedValues<RecordedEstimate>(recording, paths[i]),
                            page.column(column + "_force"), page.column(column + "_moment")});
    }
  }

  void show(std::size_t sample) {
    for (const Estimate& each : estimates_) {
      const RecordedEstimate now = each.values[sample];
      const bool fits = now.valid && now.wrench_in_base.size() == space_.dimension();
      page_.set(each.force, fits ? now.wrench_in_base.head(space_.translations()).norm() : no_value);
      page_.set(each.moment, fits ? now.wrench_in_base.tail(space_.rotations()).norm() : no_value);
    }
  }

 private:
  struct Estimate {
    RecordedValues<RecordedEstimate> values;
    std::size_t force, moment;  ///< columns
  };

  ConfigurationSpace space_;
  PageSamples& page_;
  std::vector<Estimate> estimates_;
};

/// What the drives do, each for itself, and how far the robot is from where it must not be.
class Drives {
 public:
  Drives(const ParallelRobot& robot, const Recording& recording, bool simulated, PageSamples& page)
      : command_(recording, "torque_command"),
        measures_(recording, "measures"),
        sigma_kappa_(page.column("sigma_kappa")),
        sigma_sc_(page.column("sigma_sc")),
        page_(page) {
    for (const std::string& name : numbered("torque_commanded_", robot.drives()))
      commanded_.push_back(page.column(name));
    if (!simulated) return;
    for (const std::string& name : numbered("torque_applied_", robot.drives()))
      applied_.push_back(page.column(name));
  }

  void show(std::size_t sample, const Truth* truth) {
    const TorqueCommand command = command_[sample];
    set(commanded_, command.valid ? command.torque : JointVector());
    if (truth != nullptr) set(applied_, truth->robot.drive_torque);
    const WorkspaceMeasures now = measures_[sample];
    page_.set(sigma_kappa_, now.valid ? now.sigma_kappa : no_value);
    page_.set(sigma_sc_, now.valid ? now.sigma_sc : no_value, now.valid ? 1.0 / now.sigma_sc : no_value);
  }

 private:
  void set(const std::vector<std::size_t>& columns, const JointVector& torque) {
    for (std::size_t i = 0; i < columns.size(); ++i) {
      const auto drive = static_cast<Eigen::Index>(i);
      page_.set(columns[i], drive < torque.size() ? torque[drive] : no_value);
    }
  }

  RecordedValues<TorqueCommand> command_;
  RecordedValues<WorkspaceMeasures> measures_;
  std::vector<std::size_t> commanded_, applied_;
  std::size_t sigma_kappa_, sigma_sc_;
  PageSamples& page_;
};

/// How far obstacles are from where they are drawn. Those that never move have no columns.
class ObstacleColumns {
 public:
  ObstacleColumns(const Recording& recording, std::size_t obstacles, int translations, PageSamples& page)
      : translations_(translations) {
    if (recording.find("obstacles") == nullptr) return;
    places_.emplace(recording, "obstacles");
    for (std::size_t i = 0; i < std::min(obstacles, moves_.size()); ++i) {
      columns_.emplace_back(page, named("obstacle_" + std::to_string(i + 1) + "_", translations));
    }
  }

  void show(std::size_t sample, double hardness) {
    if (!places_) return;
    const RecordedObstacles now = (*places_)[sample];
    for (std::size_t i = 0; i < columns_.size(); ++i) {
      moves_[i] |= !now.displacement_in_base[i].isZero(0.0);
      columns_[i].set(now.displacement_in_base[i].head(translations_), hardness);
    }
  }

  void drop_those_at_rest(Report& report) const {
    for (std::size_t i = 0; i < columns_.size(); ++i) {
      if (moves_[i]) continue;
      for (const std::string& name : named("obstacle_" + std::to_string(i + 1) + "_", translations_)) {
        report.columns.erase(name);
      }
    }
  }

 private:
  int translations_;
  std::optional<RecordedValues<RecordedObstacles>> places_;
  std::vector<VectorColumns> columns_;
  std::array<bool, std::tuple_size_v<decltype(RecordedObstacles::displacement_in_base)>> moves_{};
};

/// Named states, and the force of the hardest contact. Whether it counts as one is told as for the verdict,
/// so that the lane ends when the verdict says that the contact was removed.
class States {
 public:
  States(bool contacts_are_known, bool is_controlled, PageSamples& page)
      : page_(page), is_controlled_(is_controlled) {
    if (contacts_are_known) {
      force_ = page.column("contact_force");
      touching_ = page.lane("contact", {"free", "touching"});
    }
    if (!is_controlled) return;
    detector_ = page.lane("detector", {"quiet", "contact", "hard contact"});
    mode_ = page.lane("mode", {"nominal", "stopped", "react", "hold", "zero-g", "recover"});
    gate_ = page.lane("torque gate", {"waiting", "open", "closed", "recovering"});
  }

  void show(const RunSample& now, double hardness) {
    if (force_) {
      const bool known = !std::isnan(now.load());
      page_.set(*force_, now.force());
      page_.set_state(*touching_, known ? (now.load() > 1.0 ? 1 : 0) : -1, now.load());
    }
    if (!is_controlled_) return;
    const int level = static_cast<int>(now.detection.level);
    page_.set_state(detector_, level, level);
    const int mode = static_cast<int>(now.mode);
    page_.set_state(mode_, mode < 2 ? 1 - mode : mode, hardness);  // the quiet state, nominal, comes first
    page_.set_state(gate_, static_cast<int>(now.gate.phase), static_cast<int>(now.gate.phase));
  }

 private:
  PageSamples& page_;
  bool is_controlled_;  ///< what the controller does is known
  std::optional<std::size_t> force_, touching_;
  std::size_t detector_ = 0, mode_ = 0, gate_ = 0;
};

/// What the robot takes for touched, where, and how far off.
class Isolation {
 public:
  /// Recordings of control paths that do not classify show nothing of it.
  Isolation(const ParallelRobot& robot, const Recording& recording, bool simulated, PageSamples& page)
      : robot_(robot), classes_(robot.body_count(), robot.legs()), page_(page) {
    if (recording.find("classification") == nullptr || recording.find("location") == nullptr) return;
    classification_.emplace(recording, "classification");
    location_.emplace(recording, "location");
    std::vector<std::string> names;
    for (int i = 0; i < classes_.count(); ++i) names.push_back("probability_" + classes_.name(i));
    probability_.emplace(page, names);
    point_.emplace(page, named("isolated_", robot.space_dimension()));
    taken_for_.emplace(robot, page);
    if (simulated) {
      location_error_ = page.column("location_error");
      force_error_ = page.column("force_error");
    }
    if (simulated && recording.find("particles_particle_filter") != nullptr) add_particles(recording);
  }

  void show(std::size_t sample, const RunSample& run, const Truth* truth, double hardness) {
    if (!classification_) return;
    const RecordedClassification said = (*classification_)[sample];
    probability_->set(said.valid ? said.probability : ClassVector(), hardness);
    taken_for_->show(said, hardness);
    const ContactLocation found = (*location_)[sample];
    const bool located = found.valid && found.located;
    point_->set(located ? found.point_in_base : CartesianVector(), hardness);
    if (truth != nullptr) show_errors(found, located && run.is_touched(), truth->contact.strongest, hardness);
    if (cloud_) show_particles((*cloud_)[sample], truth->robot.pose, hardness);
  }

 private:
  void add_particles(const Recording& recording) {
    cloud_.emplace(recording, "particles_particle_filter");
    for (const std::string& name : numbered("particle_", most_page_particles)) {
      particles_.emplace_back(page_, named(name + "_", robot_.space_dimension()));
    }
  }
  void show_errors(const ContactLocation& found, bool known, const RecordedTouch& touch, double hardness) {
    known = known && touch.body >= 0 && touch.point_in_base.size() == found.point_in_base.size();
    page_.set(location_error_, known ? (found.point_in_base - touch.point_in_base).norm() : no_value,
              hardness);
    page_.set(force_error_, known ? (found.force_in_base - touch.force_in_base).norm() : no_value, hardness);
  }

  /// Every few of them, on the axis of their link.
  void show_particles(const ParticleCloud& cloud, const Configuration& pose, double hardness) {
    if (cloud.count > 0) robot_.kinematics(pose, PlatformVector::Zero(robot_.dof()), kinematics_);
    for (std::size_t i = 0; i < particles_.size(); ++i) {
      const auto chosen =
          static_cast<Eigen::Index>(i * static_cast<std::size_t>(cloud.count) / particles_.size());
      if (cloud.count == 0) {
        particles_[i].set_no_data();
        continue;
      }
      const BodyId link = BodyId::from_index(cloud.body);
      particles_[i].set(
          robot_.point_on_body(kinematics_, link, robot_.axis_point(link, cloud.fraction[chosen])), hardness);
    }
  }

  const ParallelRobot& robot_;
  ContactClasses classes_;
  PageSamples& page_;
  Kinematics kinematics_;
  std::optional<RecordedValues<RecordedClassification>> classification_;
  std::optional<RecordedValues<ContactLocation>> location_;
  std::optional<RecordedValues<ParticleCloud>> cloud_;
  std::optional<VectorColumns> probability_, point_;
  std::vector<VectorColumns> particles_;
  std::optional<ClassificationTimeline> taken_for_;
  std::size_t location_error_ = 0, force_error_ = 0;
};

}  // namespace

void add_samples(const ParallelRobot& robot, const Recording& recording, Report& report, std::size_t together,
                 const std::function<void(double share)>& progress) {
  const RecordedRun run(recording, robot.space());
  const bool simulated = run.witness() == Witness::truth;
  report.period = run.period() * static_cast<double>(together);
  if (!recording.time_ns.empty()) report.start = 1e-9 * static_cast<double>(recording.time_ns.front());
  PageSamples page(together);
  const bool is_controlled = !recording.attributes.contains(rig_alone);
  States states(run.witness() != Witness::none, is_controlled, page);
  std::optional<StationLanes> station;
  if (!is_controlled) station.emplace(recording, page);
  Motion motion(robot, recording, simulated, page);
  Forces forces(robot, recording, simulated, page);
  EstimatesSideBySide estimates(robot.space(), recording, page, report);
  Drives drives(robot, recording, simulated, page);
  ConstraintLane constraints(recording, page);
  LimitLane limits(recording, page);
  ReactionLane reaction(recording.find("reaction_task") != nullptr, robot.legs(), page);
  TaskEnergyColumns energies(recording, page);
  OperatorLane operator_lane(recording, page);
  Isolation isolation(robot, recording, simulated, page);
  ObstacleColumns obstacles(recording, report.obstacles.size(), robot.space().translations(), page);
  std::optional<RecordedTruths> truths;
  if (simulated) truths.emplace(recording);
  for (std::size_t k = 0; k < run.size(); ++k) {
    if (progress && k % Recording::block == 0)
      progress(static_cast<double>(k) / static_cast<double>(run.size()));
    const RunSample now = run[k];
    const std::optional<Truth> known = truths ? std::optional((*truths)[k]) : std::nullopt;
    const Truth* const truth = known ? &*known : nullptr;
    const double hardness = std::isnan(now.force()) ? 0.0 : now.force();
    page.begin();
    states.show(now, hardness);
    if (station) station->show(k);
    motion.show(k, truth, hardness);
    forces.show(k, truth, hardness);
    estimates.show(k);
    drives.show(k, truth);
    constraints.show(k);
    limits.show(k);
    reaction.show(now.task, hardness);
    energies.show(k, now.mode);
    operator_lane.show(k);
    isolation.show(k, now, truth, hardness);
    obstacles.show(k, hardness);
  }
  page.finish(report);
  obstacles.drop_those_at_rest(report);
  constraints.drop_unless_kept(report);
  limits.drop_unless_kept(report);
  operator_lane.drop_unless_used(report);
  add_elbows(robot, report);
}

}  // namespace flinch
