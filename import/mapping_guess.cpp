#include "import/mapping_guess.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <numbers>

#include "import/clock_guess.h"
#include "import/log_candidate.h"
#include "import/log_track.h"
#include "import/motion_correlation.h"
#include "systems/foundation/median.h"
#include "systems/foundation/setup_error.h"
#include "systems/robot/kinematic_check.h"
#include "systems/robot/parallel_robot.h"

namespace flinch {
namespace {

constexpr std::size_t most_columns = 500;
constexpr std::size_t most_tried = 60;  // columns that look like positions
constexpr double degree = std::numbers::pi / 180.0;

/// What is guessed, while it is.
class Guess {
 public:
  Guess(const std::filesystem::path& log, const std::filesystem::path& robot) : file_(open_log(log)) {
    guess_.mapping.log = log;
    guess_.mapping.scenario = scenario_of_robot(robot);
    read_candidates();
  }

  MappingGuess made() {
    ClockGuess clock = guess_clock(*file_, guess_.mapping.log, candidates_);
    guess_.mapping.clock = clock.clock;
    guess_.clock_unit = clock.unit;
    guess_.reasons = std::move(clock.reasons);
    find_positions();
    find_passive();
    find_drives();
    find_imu();
    find_force_torque();
    return std::move(guess_);
  }

 private:
  const ParallelRobot& robot() const { return *guess_.mapping.scenario.robot.robot; }
  const LogColumn& column(std::size_t index) const { return file_->columns()[index]; }
  void reason(const std::string& text) { guess_.reasons.push_back(text); }
  void question(const std::string& text) { guess_.questions.push_back(text); }

  void read_candidates() {
    std::vector<std::size_t> wanted;
    for (std::size_t i = 0; i < file_->columns().size() && wanted.size() < most_columns; ++i) {
      if (!column(i).is_alias) wanted.push_back(i);
    }
    std::vector<std::vector<double>> numbers = file_->read(wanted, looked_at_rows);
    for (std::size_t i = 0; i < wanted.size(); ++i)
      candidates_.push_back(
          {wanted[i], role_of(column(wanted[i]).name, column(wanted[i]).unit), std::move(numbers[i])});
  }

  std::vector<const LogCandidate*> with_role(ColumnRole role) const {
    std::vector<const LogCandidate*> found;
    for (const LogCandidate& candidate : candidates_) {
      if (candidate.role.role == role && candidate.largest() >= 0.0) found.push_back(&candidate);
    }
    return found;
  }

  std::string names_of(const std::vector<const LogCandidate*>& some) const {
    std::string names;
    for (const LogCandidate* each : some)
      names += (names.empty() ? "'" : ", '") + column(each->column).name + "'";
    return names;
  }

  // ---- joints
  void map(const LogCandidate& candidate, const std::string& signal, int entry, const std::string& unit,
           double factor, double sign = 1.0) {
    MappedColumn mapped;
    mapped.column = column(candidate.column).name;
    mapped.signal = signal;
    mapped.entry = entry;
    mapped.scale = sign * factor;
    if (signal.starts_with("joints") && unit != "m" && unit != "mm")
      mapped.turn = 2.0 * std::numbers::pi / factor;
    guess_.mapping.columns.push_back(mapped);
    guess_.units.push_back(unit);
  }

  /// The unit that the log tells, or the first of `others` by which the largest number is below `most`.
  UnitWord unit_of(const std::vector<const LogCandidate*>& group, UnitWord::Quantity quantity,
                   const std::vector<std::string>& others, double most) {
    for (const LogCandidate* each : group) {
      const std::optional<UnitWord> told = unit_word(column(each->column).unit);
      if (told && told->quantity == quantity) return *told;
    }
    double largest = 0.0;
    for (const LogCandidate* each : group) largest = std::max(largest, each->largest());
    for (const std::string& name : others) {
      const std::optional<UnitWord> word = unit_word(name);
      if (word && largest * word->to_si <= most) return *word;
    }
    return *unit_word(others.front());
  }

  static std::vector<JointVector> rows_of(const std::vector<const LogCandidate*>& group, double factor) {
    std::vector<std::vector<double>> columns;
    for (const LogCandidate* each : group) {
      columns.push_back(each->values);
      unwrap(columns.back(), 2.0 * std::numbers::pi / factor);
    }
    std::vector<JointVector> rows;
    const std::size_t step = std::max<std::size_t>(1, columns.front().size() / 4000);
    for (std::size_t k = 0; k < columns.front().size(); k += step) {
      JointVector row(static_cast<Eigen::Index>(group.size()));
      for (std::size_t i = 0; i < group.size(); ++i)
        row[static_cast<Eigen::Index>(i)] = k < columns[i].size() ? factor * columns[i][k] : std::nan("");
      if (row.allFinite()) rows.push_back(row);
    }
    return rows;
  }

  UnitWord unit_of_positions(const std::vector<const LogCandidate*>& group) {
    return robot().drive_kind(0) == DriveKind::revolute
               ? unit_of(group, UnitWord::Quantity::angle, {"rad", "deg"}, 12.6)
               : unit_of(group, UnitWord::Quantity::length, {"m", "mm"}, 5.0);
  }

  /// Whether columns differ by their numbers only, "q1" and "q2".
  bool have_one_name(const std::vector<const LogCandidate*>& group) const {
    const auto letters = [&](const LogCandidate* each) {
      std::string name = column(each->column).name;
      std::erase_if(name, [](char letter) { return letter >= '0' && letter <= '9'; });
      return name;
    };
    return std::all_of(group.begin(), group.end(),
                       [&](const LogCandidate* each) { return letters(each) == letters(group.front()); });
  }

  /// Where the columns of the drives begin: the first of those side by side, or others as which the robot can
  /// stand in more of the rows, where a log has also what was filtered, wanted or simulated.
  std::size_t first_of_positions(const std::vector<const LogCandidate*>& found) {
    const auto drives = static_cast<std::size_t>(robot().drives());
    std::size_t best = 0;
    double most = 0.0;
    for (std::size_t first = 0; first + drives <= std::min(found.size(), most_tried); ++first) {
      const auto begin = found.begin() + static_cast<std::ptrdiff_t>(first);
      const std::vector<const LogCandidate*> group(begin, begin + static_cast<std::ptrdiff_t>(drives));
      if (first % drives != 0 && !have_one_name(group)) continue;
      const double share =
          check_kinematics(robot(), rows_of(group, unit_of_positions(group).to_si)).valid_fraction;
      if (share > most + 0.05) best = first, most = share;
      if (most > 0.9) break;
    }
    return best;
  }

  void find_positions() {
    const auto drives = static_cast<std::size_t>(robot().drives());
    std::vector<const LogCandidate*> found = with_role(ColumnRole::position);
    const bool slides = robot().drive_kind(0) != DriveKind::revolute;
    if (found.size() < drives)
      throw SetupError(guess_.mapping.log.string() + ": the robot has " + std::to_string(drives) +
                       " drives, and " + std::to_string(found.size()) + " columns look like their positions" +
                       (found.empty() ? "" : " (" + names_of(found) + ")") + "; write a mapping");
    const auto first = found.begin() + static_cast<std::ptrdiff_t>(first_of_positions(found));
    positions_.assign(first, first + static_cast<std::ptrdiff_t>(drives));
    others_.assign(found.begin(), first);
    others_.insert(others_.end(), first + static_cast<std::ptrdiff_t>(drives), found.end());
    const UnitWord unit = unit_of_positions(positions_);
    double factor = unit.to_si;
    std::string word(unit.word);
    KinematicCheck check = check_kinematics(robot(), rows_of(positions_, factor));
    const bool is_told = !column(positions_.front()->column).unit.empty();
    if (!slides && (check.valid_fraction < 0.9 || (!is_told && word == "rad"))) {
      const double other = word == "rad" ? degree : 1.0;
      const KinematicCheck tried = check_kinematics(robot(), rows_of(positions_, other));
      if (tried.valid_fraction > check.valid_fraction + 0.2) {
        if (is_told)
          question("'" + column(positions_.front()->column).name + "' says " + word +
                   ", but the robot can only stand so in " + (word == "rad" ? "deg" : "rad") +
                   ": is its unit another? That was taken");
        word = word == "rad" ? "deg" : "rad";
        factor = other;
        check = tried;
      }
    }
    reason("positions of the drives are " + names_of(positions_) + " in " + word +
           ": the robot can stand so in " + percent(check.valid_fraction) + " of the rows");
    if (check.valid_fraction < 0.9)
      question("are the drives in this order and of this sign? The robot stands so in " +
               percent(check.valid_fraction) + " of the rows only");
    tell_folds(check);
    for (std::size_t i = 0; i < drives; ++i)
      map(*positions_[i], "joints.active", static_cast<int>(i), word, factor);
    factor_ = factor;
  }

  static std::string percent(double share) {
    const std::string text = std::to_string(std::floor(1000.0 * share) / 10.0);
    return text.substr(0, text.find('.') + 2) + " %";
  }

  void tell_folds(const KinematicCheck& check) {
    if (check.folds_from_home(robot()))
      reason("at its begin a leg has its elbow on another side than the robot file says");
    std::map<int, std::pair<std::size_t, std::size_t>> legs;
    for (const KinematicCheck::Fold& fold : check.folds()) {
      auto& [count, first] = legs[fold.leg];
      if (count++ == 0) first = fold.row;
    }
    for (const auto& [leg, seen] : legs)
      reason("leg " + std::to_string(leg + 1) + " changes its elbow side " + std::to_string(seen.first) +
             (seen.first == 1 ? " time" : " times") + " (type I), first in row " +
             std::to_string(seen.second + 1));
  }

  /// Passive joints that close the legs, of those side by side: others are angles of something else.
  void find_passive() {
    const auto passive = static_cast<std::size_t>(robot().passive_joints());
    if (passive == 0) return;
    std::vector<const LogCandidate*> found = with_role(ColumnRole::passive_position);
    if (found.size() < passive) found = others_;
    if (found.size() < passive) return;
    std::vector<const LogCandidate*> best;
    double least = INFINITY;
    for (std::size_t first = 0; first + passive <= std::min(found.size(), most_tried); ++first) {
      const auto begin = found.begin() + static_cast<std::ptrdiff_t>(first);
      const std::vector<const LogCandidate*> group(begin, begin + static_cast<std::ptrdiff_t>(passive));
      const double miss = miss_of(group);
      if (best.empty() || miss < 0.5 * least) best = group, least = miss;
    }
    if (!std::isfinite(least)) return;
    if (!(least < 0.02)) {
      reason(names_of(best) + " close no leg of the robot (they miss by " + std::to_string(1e3 * least) +
             " mm): left out");
      return;
    }
    reason("passive joints are " + names_of(best) + ": the legs close to " + std::to_string(1e3 * least) +
           " mm" +
           (least < 1e-8 ? "; so exactly that they were computed from the drives, and tell nothing" : ""));
    const UnitWord unit = unit_of_passive(best);
    for (std::size_t i = 0; i < passive; ++i)
      map(*best[i], "joints.passive", static_cast<int>(i), std::string(unit.word), unit.to_si);
  }

  UnitWord unit_of_passive(const std::vector<const LogCandidate*>& group) {
    return unit_of(group, UnitWord::Quantity::angle, {"rad", "deg"}, 12.6);
  }

  /// By how much the legs do not close with these passive joints, in the median [m]; infinite: unknown.
  double miss_of(const std::vector<const LogCandidate*>& group) {
    const std::vector<JointVector> active = rows_of(positions_, factor_),
                                   angles = rows_of(group, unit_of_passive(group).to_si);
    Configuration pose = robot().home_pose();
    std::vector<double> misses;
    for (std::size_t k = 0; k < std::min(active.size(), angles.size()); ++k) {
      const ForwardSolution solution =
          robot().forward_kinematics(active[k], pose, robot().home_working_mode());
      if (!solution.converged) continue;
      pose = solution.pose;
      misses.push_back(robot().chain_closure_error(active[k], angles[k], pose));
    }
    if (misses.empty()) return INFINITY;
    return median(std::move(misses));
  }

  // ---- drives
  void find_drives() {
    const auto drives = static_cast<std::size_t>(robot().drives());
    const JointVector& constant = guess_.mapping.scenario.control.drive_torque.torque_constant;
    const double most_torque = guess_.mapping.scenario.robot.drives.max_torque;
    std::vector<const LogCandidate*> currents = with_role(ColumnRole::current);
    const bool has_current = currents.size() >= drives;
    const bool slides = robot().drive_kind(0) != DriveKind::revolute;
    if (!has_current) currents = with_role(slides ? ColumnRole::force : ColumnRole::torque);
    if (currents.size() < drives) {
      question(
          "which columns are the currents or torques of the drives? None was found, so no force can be told");
      return;
    }
    currents.resize(drives);
    const double most = 3.0 * most_torque / (has_current ? constant.minCoeff() : 1.0);
    const UnitWord unit = has_current ? unit_of(currents, UnitWord::Quantity::current, {"A", "mA"}, most)
                          : slides    ? unit_of(currents, UnitWord::Quantity::force, {"N", "kN"}, most)
                                      : unit_of(currents, UnitWord::Quantity::moment, {"Nm", "mNm"}, most);
    reason(std::string(has_current ? "currents" : "torques") + " of the drives are " + names_of(currents) +
           " in " + std::string(unit.word));
    std::string unsure;
    for (std::size_t i = 0; i < drives; ++i) {
      const double with_motion = correlation_with_motion(currents[i]->values, positions_[i]->values);
      double sign = 1.0;
      if (with_motion < -0.6) {
        sign = -1.0;
        reason("'" + column(currents[i]->column).name +
               "' is taken negative: friction and inertia ask for the other sign");
      } else if (with_motion < 0.6) {
        unsure += (unsure.empty() ? "'" : ", '") + column(currents[i]->column).name + "'";
      }
      map(*currents[i], has_current ? "drives.current" : torque_signal, static_cast<int>(i),
          std::string(unit.word), unit.to_si, sign);
    }
    if (!unsure.empty())
      question(
          "does a positive number in " + unsure +
          " drive towards a larger angle? The motion in this log does not tell; 'negate: true' turns it");
  }

  // ---- instruments
  /// The columns of a role for x, y, z; null where one is missing.
  std::array<const LogCandidate*, 3> axes_of(ColumnRole role) const {
    std::array<const LogCandidate*, 3> axes{};
    for (const LogCandidate* each : with_role(role)) {
      const int axis = each->role.axis;
      if (axis >= 0 && axes[static_cast<std::size_t>(axis)] == nullptr)
        axes[static_cast<std::size_t>(axis)] = each;
    }
    return axes;
  }

  void find_imu() {
    const auto gyro = axes_of(ColumnRole::angular_velocity), acc = axes_of(ColumnRole::specific_force);
    const auto whole = [](const auto& axes) {
      return std::all_of(axes.begin(), axes.end(), [](const LogCandidate* each) { return each != nullptr; });
    };
    if (!whole(gyro) || !whole(acc)) return;
    std::vector<double> norms;
    for (std::size_t k = 0; k < acc[0]->values.size(); ++k)
      norms.push_back(std::hypot(acc[0]->values[k], acc[1]->values[k], acc[2]->values[k]));
    std::erase_if(norms, [](double norm) { return !std::isfinite(norm); });
    if (norms.empty()) return;
    const double norm = median(std::move(norms));
    const std::string by_size = norm > 0.8 && norm < 1.25 ? "g" : norm > 800.0 ? "mg" : "m/s^2";
    const UnitWord acceleration =
        unit_of({acc.begin(), acc.end()}, UnitWord::Quantity::acceleration, {by_size}, INFINITY);
    const UnitWord rotation =
        unit_of({gyro.begin(), gyro.end()}, UnitWord::Quantity::angular_velocity, {"rad/s", "deg/s"}, 20.0);
    const double size = norm * acceleration.to_si;
    reason("the IMU is " + names_of({gyro.begin(), gyro.end()}) + " in " + std::string(rotation.word) +
           " and " + names_of({acc.begin(), acc.end()}) + " in " + std::string(acceleration.word) +
           ", which is " + std::to_string(size) + " m/s^2 in the median");
    if (size < 5.0)
      question("is gravity removed from the accelerometer? Its size is " + std::to_string(size) +
               " m/s^2 in the median, and 9.8 at rest; flinch needs it with gravity");
    else if (size < 8.5 || size > 11.5)
      question("is the unit of the accelerometer another? Its size is " + std::to_string(size) +
               " m/s^2 in the median, and 9.8 at rest");
    for (std::size_t i = 0; i < 3; ++i) {
      map(*gyro[i], "imu.angular_velocity", static_cast<int>(i), std::string(rotation.word), rotation.to_si);
      map(*acc[i], "imu.specific_force", static_cast<int>(i), std::string(acceleration.word),
          acceleration.to_si);
    }
  }

  void find_force_torque() {
    const auto force = axes_of(ColumnRole::force), moment = axes_of(ColumnRole::moment);
    if (force[0] == nullptr || force[1] == nullptr) return;
    std::vector<const LogCandidate*> there;
    for (const LogCandidate* each : force) {
      if (each != nullptr) there.push_back(each);
    }
    const UnitWord unit = unit_of(there, UnitWord::Quantity::force, {"N"}, INFINITY);
    for (const LogCandidate* each : there)
      map(*each, "force_torque.force", each->role.axis, std::string(unit.word), unit.to_si);
    reason("an instrument measures forces: " + names_of(there) + " in " + std::string(unit.word) +
           ", taken in the base frame as what acts on the robot");
    for (const LogCandidate* each : moment) {
      if (each == nullptr) continue;
      const UnitWord word = unit_of({each}, UnitWord::Quantity::moment, {"Nm"}, INFINITY);
      map(*each, "force_torque.moment", each->role.axis, std::string(word.word), word.to_si);
    }
  }

  std::unique_ptr<LogFile> file_;
  MappingGuess guess_;
  std::vector<LogCandidate> candidates_;
  std::vector<const LogCandidate*> positions_;
  std::vector<const LogCandidate*> others_;  ///< positions beyond those of the drives
  double factor_ = 1.0;                      ///< of the positions, to SI
};

}  // namespace

MappingGuess guess_mapping(const std::filesystem::path& log, const std::filesystem::path& robot) {
  return Guess(log, robot).made();
}

}  // namespace flinch
