#include "systems/config/robot_file.h"

#include <algorithm>
#include <span>
#include <utility>

#include "systems/config/config_reader.h"
#include "systems/config/file_kind.h"
#include "systems/config/robot_keys.h"
#include "systems/config/robot_kind.h"
#include "systems/foundation/nearest_name.h"
#include "systems/foundation/setup_error.h"
#include "systems/robot/parallel_robot.h"

namespace flinch {
namespace {

/// Keys and units that follow from how drives move.
struct DriveKeys {
  const char *torque_constant, *max_torque, *max_torque_rate, *max_torque_jump;
  const char *min_active, *max_active;
  Unit per_ampere, torque, torque_rate, speed, position;
};

constexpr DriveKeys keys_of_turning{"torque_constant", "max_torque",       "max_torque_rate",
                                    "max_torque_jump", "min_active_angle", "max_active_angle",
                                    unit::Nm_per_A,    unit::Nm,           unit::Nm_per_s,
                                    unit::rad_per_s,   unit::rad};
constexpr DriveKeys keys_of_sliding{
    "force_constant",    "max_force",         "max_force_rate", "max_force_jump",
    "min_active_length", "max_active_length", unit::N_per_A,    unit::N,
    unit::N_per_s,       unit::m_per_s,       unit::m};

// Of all drives: they move alike.
DriveKind drive_kind(const ParallelRobot& like) { return like.drive_kind(0); }

const DriveKeys& keys_of(const ParallelRobot& like) {
  return drive_kind(like) == DriveKind::revolute ? keys_of_turning : keys_of_sliding;
}

std::span<double> entries(auto& v) { return {v.data(), static_cast<std::size_t>(v.size())}; }

bool says_any(const ConfigReader& file, std::string_view prefix) {
  const auto keys = file.keys();
  return std::any_of(keys.begin(), keys.end(), [&](auto key) { return key.starts_with(prefix); });
}

/// Of all drives, or nothing where the file says nothing of it. Keys of the second wave begin with
/// `cogging2_`.
Cogging read_cogging(ConfigReader& file, const ParallelRobot& like) {
  Cogging cogging;
  for (int wave = 0; wave < most_cogging_waves; ++wave) {
    const std::string prefix = cogging_key(wave);
    if (!says_any(file, prefix)) continue;
    const JointVector none = JointVector::Zero(like.drives());
    CoggingWave& read = cogging.waves.emplace_back(CoggingWave{none, none, none});
    ConfigReader all = file.required();
    all.numbers(prefix + "wavelength", keys_of(like).position, entries(read.wavelength), positive);
    all.numbers(prefix + "sine", keys_of(like).torque, entries(read.sine));
    all.numbers(prefix + "cosine", keys_of(like).torque, entries(read.cosine));
  }
  return cogging;
}

/// Of all drives, or nothing where the file says nothing of it.
JointVector read_torque_delay(ConfigReader& file, const ParallelRobot& like) {
  if (!says_any(file, "torque_delay")) return {};
  JointVector delay = JointVector::Zero(like.drives());
  file.numbers("torque_delay", unit::s, entries(delay), between(-longest_torque_delay, longest_torque_delay));
  return delay;
}

DriveParameters read_drives(ConfigReader file, const ParallelRobot& like) {
  const DriveKeys& keys = keys_of(like);
  DriveParameters drives = default_drives(drive_kind(like), like.drives());
  file.numbers(keys.torque_constant, keys.per_ampere, entries(drives.torque_constant), positive);
  drives.cogging = read_cogging(file, like);
  drives.torque_delay = read_torque_delay(file, like);
  file.number(keys.max_torque, keys.torque, drives.max_torque, positive);
  file.number(keys.max_torque_rate, keys.torque_rate, drives.max_torque_rate, positive);
  file.number(keys.max_torque_jump, keys.torque, drives.max_torque_jump, positive);
  file.number("max_speed", keys.speed, drives.max_speed, positive);
  file.number("max_encoder_rate", keys.speed, drives.max_encoder_rate, positive);
  file.number("max_control_error", keys.position, drives.max_control_error, positive);
  file.number("max_unseen_motion", unit::rad, drives.max_unseen_motion, positive);
  return drives;
}

WorkspaceLimits read_limits(ConfigReader& file, const RobotKind& kind, const ParallelRobot& like) {
  const DriveKeys& keys = keys_of(like);
  WorkspaceLimits limits;
  if (kind.begin_limits) kind.begin_limits(like, limits);
  limits.centre.setZero(like.space_dimension());
  file.numbers("centre", unit::m, entries(limits.centre));
  file.number("max_distance", unit::m, limits.max_distance);
  file.number("max_rotation", unit::rad, limits.max_rotation);
  file.number("min_abs_det_A", unit::none, limits.min_abs_det_A);
  file.number("min_abs_det_B", unit::none, limits.min_abs_det_B);
  file.number("min_self_collision_distance", unit::m, limits.min_self_collision_distance);
  if (!like.description().beside_platform.empty())
    file.number("min_platform_gap", unit::m, limits.min_platform_gap);
  file.number(keys.min_active, keys.position, limits.min_active);
  file.number(keys.max_active, keys.position, limits.max_active);
  return limits;
}

/// The way out for whose robot is of none of the kinds `names`.
std::string help_with_kind(const std::string& name, const std::vector<std::string>& names) {
  if (!nearest_name(name, names).empty()) return did_you_mean(name, names);
  return known_names(names) +
         ". Any robot of legs is a file of kind 'legs' (docs/files.md); what is none is a kind of a program "
         "of yours (docs/your_robot.md, section 9)";
}

/// Null where the file names none.
const RobotKind* read_kind(ConfigReader& file) {
  std::vector<std::string> names;
  for (const RobotKind& kind : robot_kinds()) names.push_back(kind.name);
  std::string name;
  if (!file.has("kind")) {
    file.required().word("kind", name, names);  // says that it is missing
    return nullptr;
  }
  file.text("kind", name);
  for (const RobotKind& kind : robot_kinds()) {
    if (kind.name == name) return &kind;
  }
  if (!name.empty() || file.good()) file.problem("kind", "is '" + name + "'" + help_with_kind(name, names));
  return nullptr;
}

/// Throws SetupError where the reader of a kind has not kept what it promises.
void require_robot(const RobotKind& kind, const ParallelRobot* robot, const ConfigReader& file) {
  if (robot == nullptr && file.good())
    throw SetupError("robot kind '" + kind.name + "': its reader has made no robot and noted no problem");
  const bool fits = robot == nullptr || kind.preset == nullptr ||
                    (robot->description().drives == kind.preset->description().drives &&
                     robot->space() == kind.preset->space());
  if (!fits)
    throw SetupError("robot kind '" + kind.name + "': its reader has made a robot unlike its preset");
}

RobotFile read_any(ConfigReader file) {
  require_kind(file, FileKind::robot);
  RobotFile result;
  const RobotKind* const kind = read_kind(file);
  if (kind == nullptr) {
    file.leave_rest_unread();
    file.finish();  // throws
    return result;
  }
  for (ConfigReader& calibration : file.sections("calibrations")) calibration.leave_rest_unread();
  result.robot = kind->read(file);
  require_robot(*kind, result.robot.get(), file);
  const auto& like = result.robot ? result.robot : kind->preset;
  if (like == nullptr) {  // Of these nothing can be said without the robot.
    read_control_period(file, result.control_period);
    for (const char* const section : {"drives", "workspace_limits"}) file.leave_unread(section);
    file.finish();  // throws
    return result;
  }
  read_control_period(file, result.control_period);
  result.drives = read_drives(file.section("drives"), *like);
  ConfigReader limits = file.section("workspace_limits");
  result.limits = read_limits(limits, *kind, *like);
  if (file.good()) {
    note_problems(limits, problems(result.limits, *result.robot),
                  [](const std::string& field) { return field; });
  }
  result.values = file.finish();
  return result;
}

}  // namespace

RobotFile read_robot_file(const std::filesystem::path& file) { return read_any(ConfigReader::open(file)); }

RobotFile parse_robot_file(std::string_view text, const std::string& file) {
  return read_any(ConfigReader::parse(text, file));
}

std::optional<RobotFile> preset_of_kind(const std::filesystem::path& file) {
  try {
    ConfigReader reader = ConfigReader::open(file);
    const RobotKind* const kind = read_kind(reader);
    if (kind == nullptr || kind->preset == nullptr) return std::nullopt;
    RobotFile preset;
    preset.robot = kind->preset;
    preset.drives = default_drives(drive_kind(*kind->preset), kind->preset->drives());
    return preset;
  } catch (const SetupError&) {
    return std::nullopt;
  }
}

std::shared_ptr<const ParallelRobot> load_robot(const std::filesystem::path& file) {
  return read_robot_file(file).robot;
}

std::string drive_constant_key(const ParallelRobot& robot, int drive) {
  const bool turns = robot.drive_kind(drive) == DriveKind::revolute;
  return std::string(turns ? "drives.torque_constant_Nm_per_A[" : "drives.force_constant_N_per_A[") +
         std::to_string(drive) + "]";
}

}  // namespace flinch
