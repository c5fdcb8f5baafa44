#include "identification/pull_windows.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>

#include "identification/encoder_motion.h"
#include "identification/motor_currents.h"
#include "identification/robust_mean.h"
#include "systems/foundation/setup_error.h"
#include "systems/framework/recorded_values.h"
#include "systems/robot/dynamic_parameters.h"
#include "systems/robot/parameter_variants.h"
#include "systems/signals/force_torque_reading.h"

namespace flinch {
namespace {

constexpr double cutoff_frequency = 20.0;  // of the motion [Hz]
constexpr Time window_length = 100ms;
constexpr Time settling = 100ms;         // of the instrument, after it is mounted
constexpr double clipped_scatter = 0.1;  // of what is usual: a component that stands still is at its limit

Eigen::Vector3d in_space(const CartesianVector& v) {
  Eigen::Vector3d full = Eigen::Vector3d::Zero();
  full.head(v.size()) = v;
  return full;
}

/// A body at an instant: its axes, and the maps from force and moment in them to the drives.
struct BodyAt {
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
  PullWindow::ForceMap force_map, moment_map;

  BodyAt(const ParallelRobot& robot, const Kinematics& at, const InstrumentMounting& mounting) {
    const BodyId body = BodyId::from_index(mounting.body);
    const int directions = robot.space_dimension();
    const auto place = [&](const Eigen::Vector3d& p) {
      return in_space(robot.point_on_body(at, body, p.head(directions)));
    };
    const Eigen::Vector3d origin = place(Eigen::Vector3d::Zero());
    for (int i = 0; i < directions; ++i) axes.col(i) = place(Eigen::Vector3d::Unit(i)) - origin;
    const ContactJacobian point =
        robot.contact_jacobian(at, body, mounting.position_in_body.head(directions));
    const int turns = robot.space().rotations() == 0 ? 0 : static_cast<int>(point.rotation.rows());
    const Eigen::Index drives = robot.drives();
    force_map.setZero(drives, 3);
    moment_map.setZero(drives, 3);
    force_map = at.J_x_qa.transpose() * point.translation.transpose() * axes.topRows(directions);
    if (turns > 0) {
      moment_map = at.J_x_qa.transpose() * point.rotation.transpose() * axes.bottomRows(turns);
    }
  }
};

/// Columns of a stretch of samples, from which a window takes its means.
struct Samples {
  Eigen::MatrixXd current, force, moment;  // rows: samples
  std::vector<char> usable;
};

/// Force and moment turned into the axes of the body on which the instrument sits.
class Reader {
 public:
  Reader(const Recording& recording, const ParallelRobot& robot, const ValidStretch& stretch)
      : robot_(robot),
        stretch_(stretch),
        parameters_(robot.dynamic_parameters()),
        motion_(encoder_motion(recording, robot, stretch, cutoff_frequency)) {
    if (parameters_) variants_.emplace(*parameters_);
    const auto n = static_cast<Eigen::Index>(stretch.count);
    samples_.force.setZero(n, 3);
    samples_.moment.setZero(n, 3);
    currents_ = motor_currents(recording, stretch, robot.drives());
    samples_.current = currents_.current;
    const auto instrument = flinch::read<ForceTorqueReading>(recording, "force_torque");
    for (std::size_t k = 0; k < stretch.count; ++k) {
      const auto row = static_cast<Eigen::Index>(k);
      const bool loaded = std::all_of(currents_.usable.begin(), currents_.usable.end(),
                                      [k](const std::vector<char>& usable) { return usable[k] == 1; });
      const ForceTorqueReading reading = instrument[stretch.first + k];
      const bool finite = reading.force_in_base.allFinite() && reading.moment_in_base.allFinite();
      const bool good = loaded && reading.valid && finite;
      samples_.usable.push_back(good ? 1 : 0);
      if (!good) continue;
      samples_.force.row(row) = reading.force_in_base.transpose();
      samples_.moment.row(row) = reading.moment_in_base.transpose();
    }
  }

  /// Turns the rows [from, to) from the base frame to the body's.
  void turn(Eigen::Index from, Eigen::Index to, const InstrumentMounting& mounting) {
    for (Eigen::Index row = from; row < to; ++row) {
      const Kinematics at = kinematics(row);
      const Eigen::Matrix3d axes = BodyAt(robot_, at, mounting).axes;
      samples_.force.row(row) = samples_.force.row(row) * axes;
      samples_.moment.row(row) = samples_.moment.row(row) * axes;
    }
  }

  Kinematics kinematics(Eigen::Index row) const {
    Kinematics at;
    stretch_.robot(robot_).kinematics(motion_.pose[static_cast<std::size_t>(row)],
                                      motion_.velocity.row(row).transpose(), at);
    return at;
  }
  /// What the model needs for the motion at a sample, and its slopes.
  void tell_effort(Eigen::Index row, const Kinematics& at, PullWindow& window) const {
    const PlatformVector acceleration = motion_.acceleration.row(row).transpose();
    window.model_effort = model_effort(robot_, at, acceleration);
    if (!parameters_) return;
    window.effort_slopes = variants_->regressor(window.model_effort, at, acceleration);
    for (Eigen::Index j = 0; j < window.effort_slopes.cols(); ++j)
      window.effort_slopes.col(j) *= parameters_->list()[static_cast<std::size_t>(j)].deviation;
  }

  const Samples& samples() const { return samples_; }
  const MotorCurrents& currents() const { return currents_; }
  const ValidStretch& stretch() const { return stretch_; }

 private:
  const ParallelRobot& robot_;
  ValidStretch stretch_;
  std::unique_ptr<const DynamicParameters> parameters_;  // none of a robot whose parameters are not known
  std::optional<ParameterVariants> variants_;
  EncoderMotion motion_;
  MotorCurrents currents_;
  Samples samples_;
};

bool all_usable(const Samples& samples, Eigen::Index from, Eigen::Index count) {
  return std::count(samples.usable.begin() + from, samples.usable.begin() + from + count, 1) == count;
}

/// Means and deviations over the rows from `from` on.
PullWindow mean_window(const ParallelRobot& robot, const Reader& reader, Eigen::Index from,
                       Eigen::Index count, const InstrumentMounting& mounting) {
  const Samples& samples = reader.samples();
  const Eigen::Index middle = from + count / 2;
  const Kinematics at = reader.kinematics(middle);
  const BodyAt body(robot, at, mounting);
  PullWindow window;
  window.body = mounting.body;
  window.axes = body.axes;
  window.current.resize(robot.drives());
  window.current_deviation.resize(robot.drives());
  for (int i = 0; i < robot.drives(); ++i) {
    const RobustMean mean = robust_mean(samples.current.col(i).segment(from, count));
    window.current[i] = mean.value;
    window.current_deviation[i] = mean.deviation;
  }
  for (int i = 0; i < 3; ++i) {
    window.force[i] = robust_mean(samples.force.col(i).segment(from, count)).value;
    window.moment[i] = robust_mean(samples.moment.col(i).segment(from, count)).value;
  }
  reader.tell_effort(middle, at, window);
  window.position = at.joints.active;
  window.rate = at.rates.active;
  window.drive_map = at.J_qa_x;
  window.force_map = body.force_map;
  window.moment_map = body.moment_map;
  return window;
}

double scatter(const Eigen::VectorXd& x) { return std::sqrt((x.array() - x.mean()).square().mean()); }

/// Whether a component of the force stands still in the window, as it does at the limit of the instrument.
bool is_clipped(const Samples& samples, Eigen::Index from, Eigen::Index count, const Eigen::Vector3d& usual) {
  for (int i = 0; i < 3; ++i) {
    const Eigen::VectorXd x = samples.force.col(i).segment(from, count);
    if (usual[i] > 0.0 && std::abs(x.mean()) > 50.0 * usual[i] && scatter(x) < clipped_scatter * usual[i])
      return true;
  }
  return false;
}

/// The rows of a stretch that belong to a mounting.
struct RowRange {
  Eigen::Index from = 0, to = 0;
};

RowRange rows_of(const Recording& recording, const ValidStretch& stretch, Time start,
                 std::optional<Time> end) {
  const auto begin = recording.time_ns.begin() + static_cast<std::ptrdiff_t>(stretch.first);
  const auto last = begin + static_cast<std::ptrdiff_t>(stretch.count);
  RowRange rows;
  rows.from = std::lower_bound(begin, last, start.count()) - begin;
  rows.to = end ? std::lower_bound(begin, last, end->count()) - begin : last - begin;
  return rows;
}

/// The windows of one mounting in one stretch.
class MountingWindows {
 public:
  MountingWindows(const Recording& recording, const ParallelRobot& robot, Reader& reader,
                  const InstrumentMounting& mounting, RowRange rows)
      : recording_(recording), robot_(robot), reader_(reader), mounting_(mounting), rows_(rows) {
    length_ = std::max<Eigen::Index>(1, window_length / recording.period);
    slack_ = rows.from + mounting.slack / recording.period;
    reader_.turn(rows.from, rows.to, mounting);
  }

  /// Appends them, and returns how many were at the limit of the instrument.
  int append(PullWindow like, std::vector<PullWindow>& windows) {
    const Eigen::Index tare_from = rows_.from + settling / recording_.period;
    if (slack_ > rows_.to || slack_ - tare_from < length_ / 2) return 0;
    if (!all_usable(reader_.samples(), tare_from, slack_ - tare_from)) return 0;
    Eigen::Vector3d zero_force, zero_moment, usual;
    for (int i = 0; i < 3; ++i) {
      const Eigen::VectorXd slack = reader_.samples().force.col(i).segment(tare_from, slack_ - tare_from);
      zero_force[i] = robust_mean(slack).value;
      usual[i] = scatter(slack);
      zero_moment[i] =
          robust_mean(reader_.samples().moment.col(i).segment(tare_from, slack_ - tare_from)).value;
    }
    int clipped = 0;
    for (Eigen::Index from = rows_.from; from + length_ <= rows_.to; from += length_) {
      if (!all_usable(reader_.samples(), from, length_)) continue;
      if (is_clipped(reader_.samples(), from, length_, usual)) {
        ++clipped;
        continue;
      }
      PullWindow window = mean_window(robot_, reader_, from, length_, mounting_);
      window.recording = like.recording;
      window.mounting = like.mounting;
      window.force -= zero_force;
      window.moment -= zero_moment;
      const std::size_t sample = reader_.stretch().first + static_cast<std::size_t>(from + length_ / 2);
      window.time = to_seconds(Time(recording_.time_ns[sample]));
      windows.push_back(window);
    }
    return clipped;
  }

 private:
  const Recording& recording_;
  const ParallelRobot& robot_;
  Reader& reader_;
  const InstrumentMounting& mounting_;
  RowRange rows_;
  Eigen::Index length_ = 1;
  Eigen::Index slack_ = 0;
};

/// Numbers the pulls: a new one begins where the force rises again after it was small, or turns.
void find_pulls(std::vector<PullWindow>& windows, std::size_t first, int& next) {
  double largest = 0.0;
  for (std::size_t i = first; i < windows.size(); ++i) largest = std::max(largest, windows[i].force.norm());
  bool pulled = false;
  ++next;
  for (std::size_t i = first; i < windows.size(); ++i) {
    const bool pulls = windows[i].force.norm() > 0.3 * largest;
    if (pulls && !pulled) ++next;
    pulled = pulls;
    windows[i].cluster = next;
  }
}

}  // namespace

std::vector<PullWindow> pull_windows(const Recording& recording, const ParallelRobot& robot,
                                     const std::vector<InstrumentMounting>& mountings, int number,
                                     int first_mounting, std::vector<std::string>& warnings) {
  if (mountings.empty()) {
    throw SetupError("its scenario has no 'pulls', which say where the instrument was mounted");
  }
  if (recording.find("force_torque") == nullptr) {
    throw SetupError(
        "there is no signal 'force_torque', the readings of the instrument at which the rope pulls");
  }
  const auto least = static_cast<std::size_t>(window_length / recording.period);
  std::vector<PullWindow> windows;
  int cluster = 1000 * first_mounting;
  std::vector<Reader> readers;
  MotorCurrents defects;
  std::size_t samples = 0;
  for (const ValidStretch& stretch : valid_stretches(recording, robot, 5 * least)) {
    defects.count(readers.emplace_back(recording, robot, stretch).currents());
    samples += stretch.count;
  }
  if (samples > 0) warnings = defects.warnings(samples);
  for (std::size_t m = 0; m < mountings.size(); ++m) {
    const std::optional<Time> end =
        m + 1 < mountings.size() ? std::optional(mountings[m + 1].start) : std::nullopt;
    const std::size_t before = windows.size();
    int clipped = 0;
    for (Reader& reader : readers) {
      const RowRange rows = rows_of(recording, reader.stretch(), mountings[m].start, end);
      if (rows.to <= rows.from) continue;
      PullWindow like;
      like.recording = number;
      like.mounting = first_mounting + static_cast<int>(m);
      clipped += MountingWindows(recording, robot, reader, mountings[m], rows).append(like, windows);
    }
    find_pulls(windows, before, cluster);
    const std::string name = robot.body(BodyId::from_index(mountings[m].body)).name;
    if (windows.size() == before && clipped == 0) {
      warnings.push_back("pulls[" + std::to_string(m) + "], " + name +
                         ": no second of it is recorded with valid readings; it is left out");
    }
    if (clipped > 0) {
      warnings.push_back("pulls[" + std::to_string(m) + "], " + name + ": the instrument is saturated for " +
                         std::to_string(clipped) + " tenths of a second, which are left out; pull less hard");
    }
  }
  return windows;
}

}  // namespace flinch
