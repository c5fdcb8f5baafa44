#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "experiments/verdict/verdict.h"

namespace flinch {

/// A number and where it was taken from.
struct SourcedForce {
  double force = 0.0;  ///< [N]
  std::string_view source;
};

/// What ISO/TS 15066 permits at one region of the body.
struct BodyRegion {
  std::string_view name;      ///< as scenario files call it: "hand", "lower_arm"
  std::string_view title;     ///< as people read it
  SourcedForce quasi_static;  ///< for what lasts
  SourcedForce transient;     ///< for the first half second
};

/// Every region that is known. An engineering estimate, not a certification: whoever makes a claim takes the
/// numbers from the standard itself.
std::span<const BodyRegion> body_regions();

/// The region called `name`; null where there is none.
const BodyRegion* find_body_region(std::string_view name);

/// Its limits, the transient ones for half a second.
ForceLimits force_limits_of(const BodyRegion& region);

/// The region of `limits` as people read it; its name where it is none of these.
std::string region_of(const ForceLimits& limits);

}  // namespace flinch
