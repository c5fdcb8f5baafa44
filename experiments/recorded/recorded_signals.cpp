#include "experiments/recorded/recorded_signals.h"

#include <filesystem>

#include "diagrams/contact_control.h"
#include "diagrams/station.h"
#include "experiments/scenario/scenario.h"
#include "experiments/verdict/names_of_touched.h"
#include "systems/framework/diagram.h"
#include "systems/framework/diagram_builder.h"

namespace flinch {

namespace {

std::string separated_by_blanks(const std::vector<std::string>& names) {
  std::string all;
  for (const std::string& name : names) all += (all.empty() ? "" : " ") + name;
  return all;
}

}  // namespace

void export_readings(DiagramBuilder& builder, const Station& station) {
  builder.export_output("joints", station.joints);
  builder.export_output("drives", station.drives);
  builder.export_output("imu", station.imu);
  builder.export_output("status", station.status);
  if (station.base_forces) builder.export_output("base_forces", *station.base_forces);
  if (station.force_torque) builder.export_output("force_torque", *station.force_torque);
}

void export_control(DiagramBuilder& builder, const ContactControl& control) {
  builder.export_output("motion", control.platform_motion);
  builder.export_output("measures", control.measures);
  builder.export_output("wrench", control.wrench_estimate);
  builder.export_output("detection", control.detection);
  builder.export_output("contact_phase", control.contact);
  builder.export_output("isolation_wrench", control.isolation_wrench);
  builder.export_output("features", control.features);
  builder.export_output("evidence", control.evidence);
  builder.export_output("classification", control.classification);
  builder.export_output("location", control.location);
  builder.export_output("reaction", control.reaction_state);
  builder.export_output("reference", control.reference);
  builder.export_output("requested_torque", control.requested_torque);
  builder.export_output("limits", control.limits);
  builder.export_output("braking", control.braking);
  builder.export_output("torque_command", control.torque_command);
  builder.export_output("brake", control.brake);
  builder.export_output("plausibility", control.plausibility);
  builder.export_output("gate", control.gate);
  const auto show = [&builder](const auto& others) {
    for (const auto& other : others) builder.export_output(other.name, other.port);
  };
  show(control.others.joint_motions);
  show(control.others.accelerations);
  show(control.others.wrenches);
  show(control.others.detections);
  show(control.others.detections_by_estimator);
  show(control.others.torques);
  show(control.others.classifications);
  show(control.others.locations);
  show(control.others.clouds);
  show(control.others.constraints);
  show(control.others.energies);
  show(control.others.tasks);
  show(control.others.loads);
  show(control.others.drive_checks);
  show(control.others.base_forces);
  show(control.others.located_contacts);
}

std::vector<std::string> recorded_paths(const Diagram& diagram) {
  std::vector<std::string> paths;
  for (const System::Input& input : diagram.inputs()) paths.push_back(input.name);
  for (const System::Output& output : diagram.outputs()) paths.push_back(output.name);
  return paths;
}

std::map<std::string, std::string> recorded_attributes(const Scenario& scenario,
                                                       const std::map<std::string, std::string>& provenance) {
  std::map<std::string, std::string> attributes = provenance;
  attributes["flinch.version"] = FLINCH_VERSION;
  attributes["seed"] = std::to_string(scenario.seed);
  attributes["control.estimator"] = followed_name(scenario.control.stages.estimators);
  attributes["contact.classes"] = separated_by_blanks(names_of_touched(*scenario.robot.robot));
  attributes["control.detector"] = followed_name(scenario.control.stages.detectors);
  attributes["scenario.name"] = scenario.name;
  attributes["scenario.file"] = scenario.file.filename().string();
  attributes["scenario.text"] = scenario.text;
  attributes["robot.file"] = scenario.robot_file.filename().string();
  attributes["robot.text"] = scenario.robot_text;
  for (std::size_t i = 0; i < scenario.obstacles.size(); ++i)
    attributes["obstacle." + std::to_string(i + 1) + ".name"] = scenario.obstacles[i].name;
  int number = 0;
  for (const ParameterFile& file : scenario.calibrations) {
    const std::string name = "calibration." + std::to_string(++number);
    attributes[name + ".file"] = std::filesystem::path(file.file).filename().string();
    attributes[name + ".text"] = file.text;
  }
  return attributes;
}

}  // namespace flinch
