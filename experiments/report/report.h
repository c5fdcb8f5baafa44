#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace flinch {

/// A point or vector, base frame; z is 0 for a planar robot.
using ReportPoint = std::array<double, 3>;

/// Particles of a locator that a page shows.
inline constexpr int most_page_particles = 12;

/// One contact of an experiment, from the plant's ground truth and the robot's own detector.
/// What did not happen or was not measured has no value: a contact that was never detected has no `detected`.
struct ReportContact {
  std::string body;                ///< Touched body as a reader says it: "platform", "second link of leg 1".
  std::string clamping_leg;        ///< "leg 1", whose links clamp the object; empty: it was a collision.
  std::string isolated_body;       ///< Body that the robot took it for; empty: it did not say.
  bool several_contacts = false;   ///< The robot said that no single contact explains the wrench.
  std::string object;              ///< What it touched: "pylon"; "push": it was pushed without a touch.
  double start = 0.0;              ///< t_c: true contact force leaves zero [s].
  std::optional<double> detected;  ///< t_det: first tick with the detector's flag [s].
  /// When the detector of each estimator detected it [s]; empty: only one ran.
  std::vector<std::pair<std::string, std::optional<double>>> detected_by;
  /// It could still stop within its limits when it detected the contact; none: nobody judged that.
  std::optional<bool> could_stop;
  std::optional<double> removed;    ///< t_rem: the contact is over [s].
  std::optional<double> speed;      ///< Of the platform when it touched [m/s].
  double peak_force = 0.0;          ///< f_c,max: largest true contact force [N].
  std::optional<double> peak_time;  ///< When [s].
  /// Largest force after the transient duration, where that decides, and not the peak [N].
  std::optional<double> lasting_force;
  std::optional<double> force_limit;  ///< That the force is judged against [N].
  std::string limit_name;             ///< Its kind, the region of the body, and its source.
  double over_limit = 0.0;            ///< How long the force was above the limit of its time [s].
  bool within_limit = false;          ///< The verdict on the force.
};

/// A number of the verdict table other than the contacts: observer error, tracking error, loop closure.
struct ReportMeasure {
  std::string name;  ///< "Observer error, force"
  double value = 0.0;
  std::string unit;             ///< Of value and bound; empty for a count.
  std::optional<double> bound;  ///< Largest value that is still good.
  std::optional<bool> good;     ///< The verdict on `value`; none: the number is only told.
  std::string note;             ///< How it was measured: "largest, before the first contact".
};

/// One leg as it is drawn: from its base joint by way of the columns `elbow_1_x`, ... to its coupling joint.
struct ReportLeg {
  ReportPoint base{};      ///< In the base frame [m].
  ReportPoint coupling{};  ///< In the platform frame [m].
};

/// A robot as it is drawn.
struct ReportRobot {
  std::vector<ReportLeg> legs;
  double link_radius = 0.0;           ///< Half the width of a link [m].
  std::vector<ReportPoint> platform;  ///< Its outline is the hull of these points, in the platform frame [m],
  double platform_radius = 0.0;       ///< grown by this [m].
};

/// What the robot may run into, where it is at rest. The columns `obstacle_1_x`, ... move the first one.
struct ReportObstacle {
  std::string name;
  std::vector<ReportPoint> points;  ///< Its outline is the hull of these points, base frame [m],
  double radius = 0.0;              ///< grown by this [m].
};

/// A line across a chart: threshold or limit. `chart` is the id of a chart as listed in report/README.md.
struct ReportBound {
  std::string chart;
  std::string name;    ///< "reaction threshold"
  double value = 0.0;  ///< SI, as the chart's columns.
};

/// A quantity with named states over time, such as the control mode; one entry in `state` per sample.
struct ReportLane {
  std::string name;                 ///< "mode"
  std::vector<std::string> states;  ///< Names by index. By convention index 0 is the quiet state.
  std::vector<int> state;           ///< Index into `states` per sample; negative: no data.
};

/// A parameter as it took effect.
struct ReportParameter {
  std::string group;  ///< "observer"
  std::string name;   ///< "gain"
  std::string value;  ///< As text: it may be a list or a word.
  std::string unit;
  std::string note;  ///< What it does, or where it comes from.
};

/// A text that belongs to the run, shown as it is: the scenario file, the robot file.
struct ReportText {
  std::string title;
  std::string text;
};

/// Everything that the page of one experiment shows. What is left empty is left out of the page.
struct Report {
  std::string kind;  ///< "simulated experiment"; empty: it does not say.
  std::string title;
  std::string subtitle;  ///< What was tried, in one sentence: which observer, which reaction.
  std::string note;      ///< A caveat to be read before anything else; empty: none.
  bool good = false;
  std::vector<std::string> reasons;     ///< Why it is not good, one sentence each.
  std::vector<std::string> remarks;     ///< What a reader must know of a good one as well, likewise.
  std::vector<std::string> checks_off;  ///< What of sensors and drives could not be checked, likewise.
  std::string fault;                    ///< Why the robot was stopped; empty: it was not.
  bool contacts_known = true;           ///< Somebody saw what touched the robot: no contacts means none.
  std::vector<ReportContact> contacts;
  std::vector<ReportMeasure> measures;

  std::optional<ReportRobot> robot;
  std::string drive_unit = "Nm";  ///< Of the columns `torque_commanded_1`, ...
  std::vector<ReportObstacle> obstacles;

  double start = 0.0;   ///< Time of the first sample [s].
  double period = 0.0;  ///< Of the samples [s], > 0 where there are any.
  /// Signals by name, one value per sample, SI; NaN is "no data". The names that the page knows are listed
  /// in report/README.md.
  std::map<std::string, std::vector<double>> columns;
  /// The names behind the columns `estimator_1_force`, ..., first that which the robot followed; empty: only
  /// one ran.
  std::vector<std::string> estimators;
  std::vector<ReportLane> lanes;
  std::vector<ReportBound> bounds;

  std::vector<ReportParameter> parameters;  ///< Seeds among them.
  std::vector<ReportParameter> provenance;  ///< Version, command line, files, seed, times; `group` is unused.
  std::vector<ReportText> texts;

  size_t sample_count() const;  ///< Of the first column, or of the first lane.
};

/// Throws SetupError with everything that does not fit: columns or lanes of different lengths, a column or
/// chart that the page does not know, a state without a name, samples without a period.
void check_report(const Report& report);

}  // namespace flinch
