#pragma once

#include <map>
#include <string>
#include <vector>

namespace flinch {

class Diagram;
class DiagramBuilder;
struct ContactControl;
struct Scenario;
struct Station;

/// What every run records, by the names that verdict, report and replay ask for: "joints", "wrench", ...
void export_readings(DiagramBuilder& builder, const Station& station);
void export_control(DiagramBuilder& builder, const ContactControl& control);

/// The names of all inputs and outputs of `diagram` itself.
std::vector<std::string> recorded_paths(const Diagram& diagram);

/// What made a recording: `provenance`, version, seed, scenario and robot file.
std::map<std::string, std::string> recorded_attributes(const Scenario& scenario,
                                                       const std::map<std::string, std::string>& provenance);

}  // namespace flinch
