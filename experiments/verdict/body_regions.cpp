#include "experiments/verdict/body_regions.h"

#include <algorithm>
#include <array>
#include <string>

namespace flinch {
namespace {

// Where the numbers come from. None was compared with the printed standard.
constexpr std::string_view safepr = "[SafePR] V-G, which quotes ISO/TS 15066";
constexpr std::string_view table = "ISO/TS 15066:2016 Table A.2, from secondary sources";
constexpr std::string_view twice =
    "twice the quasi-static force: ISO/TS 15066:2016 A.3, from secondary sources";
constexpr std::string_view none =
    "the quasi-static force: ISO/TS 15066:2016 permits no transient contact here";

constexpr std::array regions = {
    BodyRegion{"hand", "hand and fingers", {140.0, safepr}, {280.0, safepr}},
    BodyRegion{"lower_arm", "lower arm and wrist", {160.0, safepr}, {320.0, safepr}},
    BodyRegion{"upper_arm", "upper arm and elbow", {150.0, table}, {300.0, twice}},
    BodyRegion{"chest", "chest", {140.0, table}, {280.0, twice}},
    BodyRegion{"abdomen", "abdomen", {110.0, table}, {220.0, twice}},
    BodyRegion{"pelvis", "pelvis", {180.0, table}, {360.0, twice}},
    BodyRegion{"back", "back and shoulders", {210.0, table}, {420.0, twice}},
    BodyRegion{"neck", "neck", {150.0, table}, {300.0, twice}},
    BodyRegion{"thigh", "thigh and knee", {220.0, table}, {440.0, twice}},
    BodyRegion{"lower_leg", "lower leg", {130.0, table}, {260.0, twice}},
    BodyRegion{"skull", "skull and forehead", {130.0, table}, {130.0, none}},
    BodyRegion{"face", "face", {65.0, table}, {65.0, none}},
};

}  // namespace

std::span<const BodyRegion> body_regions() { return regions; }

const BodyRegion* find_body_region(std::string_view name) {
  const auto found = std::find_if(regions.begin(), regions.end(),
                                  [name](const BodyRegion& each) { return each.name == name; });
  return found == regions.end() ? nullptr : &*found;
}

ForceLimits force_limits_of(const BodyRegion& region) {
  ForceLimits limits;
  limits.region = region.name;
  limits.transient = region.transient.force;
  limits.quasi_static = region.quasi_static.force;
  limits.transient_source = region.transient.source;
  limits.quasi_static_source = region.quasi_static.source;
  return limits;
}

std::string region_of(const ForceLimits& limits) {
  const BodyRegion* const known = find_body_region(limits.region);
  return known == nullptr ? limits.region : std::string(known->title);
}

}  // namespace flinch
