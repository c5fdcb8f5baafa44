#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace flinch::test {

/// The robot's safety values, and below which speed the platform counts as at rest.
inline constexpr double sigma_kappa_s = 15.0;
inline constexpr double sigma_sc_s = 0.17;  // [m]
inline constexpr double at_rest = 0.02;     // [m/s]

/// What the true robot did in one run of a campaign, from the detection of a contact on; its place where
/// limits are kept always, from the first tick on.
struct ReactionOutcome {
  std::size_t number = 0;  ///< of the run
  std::string law;         ///< of the reaction
  std::string body;        ///< that was to be touched
  bool touched = false;
  bool detected = false;
  bool starts_inside = false;  ///< at the start both measures are within their safety values
  /// At the detection it could still stop within the safety values, as the robot itself judges; none: it does
  /// not keep these, or detected nothing.
  std::optional<bool> says_it_could_stop;
  bool could_stop = false;        ///< the same of the true robot then; means nothing where that one is none
  bool is_lost = false;           ///< at a tick the true robot had no kinematics: the measures leave that out
  std::string fault;              ///< why the gate closed, "" if it did not
  std::optional<double> removed;  ///< after the onset of the contact that is detected [s]
  /// Largest speed of the platform in hold when nothing has touched it for 100 ms [m/s].
  double held_speed = 0.0;
  double speed = 0.0;       ///< that was asked of the platform [m/s]; 0 where that is not drawn
  double peak_force = 0.0;  ///< [N]
  /// What no reaction could have kept the contact below, see unavoidable_force(): one that begins with the
  /// next tick, and one 5 ms later [N]. 0 where the stiffness of what is touched is not drawn, and where two
  /// bodies touch first.
  double unavoidable = 0.0, unavoidable_later = 0.0;
  double sigma_kappa = 0.0;  ///< the largest
  double sigma_sc = 1.0;     ///< the smallest [m]
  double det_A = 1.0;        ///< the smallest, without sign
  double distance = 0.0;     ///< the largest, of the platform from the centre [m]
  double rotation = 0.0;     ///< the largest [rad]
  double slack = 0.0;        ///< the largest
  int steps = 0;             ///< the most of a quadratic programme
  bool reclosed = false;     ///< touched again, once detected, after a release of 100 ms
};

/// Runs every run of a campaign file, `draws` at each point of its grid, in `threads` threads; `set` as of
/// `flinch campaign --set`.
std::vector<ReactionOutcome> run_reactions(const std::filesystem::path& campaign, std::size_t draws,
                                           int threads, const std::vector<std::string>& set = {});

/// The value below which this share lies; not a number where there is none.
double quantile(std::vector<double> values, double share);

}  // namespace flinch::test
