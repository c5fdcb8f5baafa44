#include "experiments/scenario/scenario_isolation.h"

#include "diagrams/isolation_settings.h"
#include "systems/config/config_reader.h"
#include "systems/robot/parallel_robot.h"

namespace flinch {

namespace {

/// Whether the file is there tells who reads it: a recording of the scenario is read where it may be missing.
void read_network(ConfigReader& section, const char* question, std::filesystem::path& file) {
  if (!section.has(question)) return;  // that which comes with flinch
  std::string name = file.string();
  section.text(question, name);
  file = name;
}

}  // namespace

void read_wrench_errors(ConfigReader& isolation, const KnownDrives& drives, IsolationSettings& settings) {
  JointVector& errors = settings.uncertainty.drive_torque;
  std::vector<double> deviations(errors.begin(), errors.end());
  isolation.one_or_numbers("drive_deviation", drives.kind == DriveKind::revolute ? unit::Nm : unit::N,
                           deviations, drives.count, positive);
  if (deviations.size() == 1 && drives.count) deviations.resize(*drives.count, deviations.front());
  if (deviations.size() > static_cast<std::size_t>(max_dof)) return;
  errors = Eigen::Map<const Eigen::VectorXd>(deviations.data(), static_cast<Eigen::Index>(deviations.size()));
}

/// Their number is for the robot to judge.
void read_base_forces(ConfigReader reader, std::optional<BaseForceSettings>& settings) {
  BaseForceSettings read;
  std::vector<double> moments;
  reader.required().numbers("first_moment", unit::kg_m, moments, positive);
  if (moments.size() <= static_cast<std::size_t>(max_dof)) {
    read.first_moment =
        Eigen::Map<const Eigen::VectorXd>(moments.data(), static_cast<Eigen::Index>(moments.size()));
  }
  reader.number("deviation", unit::N, read.pairs.base_force, positive);
  reader.number("least_log_odds", unit::none, read.pairs.least_log_odds);
  reader.duration("period", read.period, between(1e-3, 1.0));
  settings = read;
}

void read_isolation(ConfigReader isolation, const KnownDrives& drives, IsolationSettings& settings) {
  read_wrench_errors(isolation, drives, settings);
  isolation.number("observer_gain", unit::per_s, settings.observer_gain, positive);
  isolation.number("force_deviation", unit::N, settings.uncertainty.force, positive);
  isolation.number("moment_deviation", unit::Nm, settings.uncertainty.moment, positive);
  isolation.number("force_scale", unit::N, settings.hypotheses.force_scale, positive);
  isolation.number("object_speed", unit::m_per_s, settings.hypotheses.object_speed, positive);
  isolation.number("friction", unit::none, settings.hypotheses.friction, not_negative);
  isolation.number("accept", unit::none, settings.model_classifier.accept, fraction);
  settings.decision_tree.accept = settings.model_classifier.accept;
  ConfigReader right = isolation.section("decision_tree");
  right.number("right_of_platform", unit::none, settings.decision_tree.right_of_platform, fraction);
  right.number("right_of_link1", unit::none, settings.decision_tree.right_of_link1, fraction);
  right.number("right_of_link2", unit::none, settings.decision_tree.right_of_link2, fraction);
  right.number("right_of_clamping", unit::none, settings.decision_tree.right_of_clamping, fraction);
  ConfigReader papers = isolation.section("papers_networks");
  read_network(papers, "clamping", settings.papers_networks.clamping);
  read_network(papers, "chain", settings.papers_networks.chain);
  read_network(papers, "body", settings.papers_networks.body);
  papers.number("accept", unit::none, settings.papers_networks.accept, fraction);
  ConfigReader learned = isolation.section("learned_classifier");
  read_network(learned, "network", settings.learned_network);
  isolation.number("largest_residual", unit::none, settings.model_classifier.largest_residual, positive);
  isolation.duration("window", settings.model_classifier.window, not_negative);
  isolation.number("leaning", unit::none, settings.closed_form.leaning, not_negative);
  settings.particle_filter.leaning = settings.closed_form.leaning;
  settings.closed_form.object_speed = settings.particle_filter.object_speed =
      settings.hypotheses.object_speed;
  if (isolation.has("base_forces")) read_base_forces(isolation.section("base_forces"), settings.base_forces);
  isolation.integer("particles", settings.particle_filter.particles, 1, max_particles);
}

void find_networks(const std::filesystem::path& folder, IsolationSettings& settings) {
  PapersNetworkFiles& papers = settings.papers_networks;
  for (std::filesystem::path* file :
       {&papers.clamping, &papers.chain, &papers.body, &settings.learned_network}) {
    if (!file->empty()) *file = (folder / *file).lexically_normal();
  }
}

}  // namespace flinch
