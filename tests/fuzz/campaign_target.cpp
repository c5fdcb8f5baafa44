// Campaigns, with the scenarios that they name, and one run of them.
#include "experiments/campaign/campaign.h"

#include "experiments/campaign/campaign_run.h"
#include "systems/foundation/setup_error.h"
#include "tests/fuzz/fuzz_files.h"
#include "tests/fuzz/fuzz_target.h"

namespace flinch::test {
namespace {

/// What the seeds name: short files, since those that are shipped take longer to read than any campaign.
void write_scenario() {
  fuzz_file(
      "robot.yaml",
      "{kind: five_bar, platform: {mass_kg: 0.25, radius_m: 0.02}, link_radius_m: 0.02, home_pose: {x_m: "
      "0, y_m: 0.33}, legs: [{base_joint_m: [-0.14, 0], base_angle_deg: 0, link1_length_m: 0.23, "
      "link2_length_m: 0.23, elbow_sign: -1, bodies: &b {link1: {mass_kg: 0.45, centre_of_mass_m: 0.1, "
      "inertia_kg_m2: 0.0026}, link2: {mass_kg: 0.18, centre_of_mass_m: 0.115, inertia_kg_m2: 0.0011}}}, "
      "{base_joint_m: [0.14, 0], base_angle_deg: 0, link1_length_m: 0.23, link2_length_m: 0.23, "
      "bodies: *b}]}");
  fuzz_file("scenario.yaml",
            "{robot: robot.yaml, duration_s: 1, motion: {kind: passage, start_ms: 300, pose: {x_mm: 0, y_mm: "
            "330}, direction_deg: 90, speed_m_per_s: 0.5, cruise_mm: 20, acceleration_m_per_s2: 12, "
            "jerk_m_per_s3: 600}, obstacles: [{x_m: 0, y_m: 0.5, radius_mm: 20, stiffness_N_per_m: 6000}]}");
}

void try_campaign(std::string_view bytes) {
  [[maybe_unused]] static const bool written = (write_scenario(), true);
  const Campaign campaign = read_campaign(fuzz_file("campaign.yaml", bytes));
  check_keys(campaign);
  campaign.identity();
  if (campaign.runs() == 0) return;
  try {
    draw_run(campaign, campaign.runs() - 1, 2);
  } catch (const SetupError&) {  // two draws need not be enough
  }
}

std::vector<std::string> campaign_seeds() {
  std::vector<std::string> all = shipped_files("campaigns", ".yaml");
  all.push_back(
      "{scenario: scenario.yaml, runs: 3, grid: [{key: control.momentum_observer.gain_per_s, values: [[20, "
      "20], "
      "[40, 40]]}], draw: [{key: 'obstacles[0].stiffness_N_per_m', from: 2e3, to: 2e4, scale: logarithmic}, "
      "{key: duration_s, of: [1, 2]}]}");
  for (const char* const by : {"pushing, angle_deg: 20, force_N: [20, 60]", "moving, speed_m_per_s: 0.4"})
    all.push_back(
        std::string("{scenarios: [{file: scenario.yaml}], contact: {body: [platform, link1, link2], by: ") +
        by + "}}");
  return all;
}

}  // namespace

const FuzzTarget campaign_target{"campaign", try_campaign, campaign_seeds};

}  // namespace flinch::test
