#include "experiments/simulated/scenario_realism.h"

#include "systems/config/config_reader.h"
#include "systems/robot/parallel_robot.h"

namespace flinch {
namespace {

enum class Like { none, kind, bench };

Realism read_like(ConfigReader& reader, std::string_view key, DriveKind drives) {
  Like like = Like::none;
  reader.choice(key, like, {{"none", Like::none}, {"kind", Like::kind}, {"bench", Like::bench}});
  if (like == Like::none) return {};
  return like == Like::kind ? kind_realism(drives) : rig_realism(drives);
}

void read_drives(ConfigReader& reader, bool turn, Realism& realism) {
  const char* const constant = turn ? "torque_constant" : "force_constant";
  const char* const ripple = turn ? "torque_ripple" : "force_ripple";
  const char* const ripple_periods = turn ? "torque_ripple_periods" : "force_ripple_periods";
  reader.number(constant, unit::none, realism.torque_constant, {.low = 0.0, .high = 0.9});
  reader.number("cogging", unit::none, realism.cogging, fraction);
  reader.integer("cogging_periods", realism.cogging_periods, 1, 10000);
  reader.integer("cogging_harmonics", realism.cogging_harmonics, 1, 20);
  reader.number(ripple, unit::none, realism.torque_ripple, fraction);
  reader.integer(ripple_periods, realism.torque_ripple_periods, 1, 10000);
  reader.number("current_lag", unit::s, realism.current_lag, between(0.0, 0.1));
  if (!turn) reader.number("screw_lead", unit::m, realism.screw_lead, positive);
}

void read_elastic_drives(ConfigReader& reader, bool turn, Realism& realism) {
  reader.number("drive_stiffness", turn ? unit::Nm_per_rad : unit::N_per_m, realism.drive_stiffness,
                not_negative);
  reader.number("drive_damping", unit::none, realism.drive_damping, between(0.0, 1.0));
  reader.number("backlash", turn ? unit::rad : unit::m, realism.backlash, not_negative);
  reader.number("rotor_inertia", turn ? unit::kg_m2 : unit::kg, realism.rotor_inertia, not_negative);
  if (realism.drive_stiffness > 0.0) return;
  const char* const needs = "needs a drive_stiffness above 0, without which motors and legs are one";
  if (realism.backlash > 0.0) reader.problem("backlash", needs);
  if (realism.rotor_inertia > 0.0) reader.problem("rotor_inertia", needs);
}

void read_encoders(ConfigReader& reader, bool turn, bool has_passive, Realism& realism) {
  reader.number("active_encoder_wave", turn ? unit::rad : unit::m, realism.active_encoder_wave, not_negative);
  if (!has_passive) return;
  reader.number("passive_encoder_wave", unit::rad, realism.passive_encoder_wave, not_negative);
  reader.number("passive_encoder_offset", unit::rad, realism.passive_encoder_offset, not_negative);
}

}  // namespace

Realism read_realism(ConfigReader& plant, const ParallelRobot& robot) {
  const DriveKind drives = robot.drive_kind(0);
  if (!plant.has_section("realism")) return read_like(plant, "realism", drives);
  ConfigReader reader = plant.section("realism");
  Realism realism = read_like(reader, "like", drives);
  if (reader.has("seed")) reader.seed("seed", realism.seed.emplace());
  // Nothing that must be positive may be scaled by zero.
  constexpr Range share{.low = 0.0, .high = 0.9};
  const bool turn = drives == DriveKind::revolute;
  reader.number("friction", unit::none, realism.friction, fraction);
  reader.number("friction_stiffness", turn ? unit::Nm_per_rad : unit::N_per_m, realism.friction_stiffness,
                not_negative);
  reader.number("leg_inertia", unit::none, realism.leg_inertia, share);
  reader.number("platform_inertia", unit::none, realism.platform_inertia, share);
  reader.number("payload", unit::kg, realism.payload, not_negative);
  read_drives(reader, turn, realism);
  read_elastic_drives(reader, turn, realism);
  read_encoders(reader, turn, robot.passive_joints() > 0, realism);
  return realism;
}

}  // namespace flinch
