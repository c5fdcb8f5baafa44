#pragma once

namespace flinch {

struct TouchPairsSettings {
  double force_scale = 50.0;  ///< standard deviation of a contact's force before anything is known [N]
  double leaning = 0.15;      ///< root mean square of tangential over normal force
  /// Standard deviation of each component at the bases without a contact [N]: half more than 36 s of random
  /// motion of realistic robots have.
  double base_force = 0.8;
  double share_of_force = 0.03;  ///< of the size of what a leg's base feels, on each component of it
  /// ln of how many times likelier two contacts must be than one, to be told as two.
  double least_log_odds = 8.0;
  /// Largest e^T S^-1 e that the best explanation may leave; beyond, nothing explains what is felt.
  double largest_residual = 40.0;
  int places_around = 24;  ///< tried first around the platform
  int places_along = 8;    ///< tried first on each side of a link
};

}  // namespace flinch
