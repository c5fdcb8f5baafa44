#include "experiments/robot_check/workspace_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "experiments/robot_check/robot_workspace.h"
#include "systems/foundation/html_page.h"
#include "systems/robot/parallel_robot.h"

namespace flinch {
namespace {

constexpr double width = 420.0, margin = 46.0;  // of a drawing [px]
constexpr int cells = 84;                       // along the longer side
constexpr double light_condition = 1.0, dark_condition = 20.0;

/// The colour of a pose: what is out of reach has none.
std::string colour_of(const WorkspacePose& pose) {
  if (pose.beyond_singularity) return "#e8b4ae";
  if (!pose.is_within()) return "#d4d7dc";
  const double depth =
      std::log(pose.sigma_kappa / light_condition) / std::log(dark_condition / light_condition);
  const double share = std::clamp(depth, 0.0, 1.0);
  const auto between = [&](double light, double dark) {
    return static_cast<int>(std::lround(light + share * (dark - light)));
  };
  return fmt::format("#{:02x}{:02x}{:02x}", between(214, 24), between(236, 78), between(222, 92));
}

/// One section through home, along two of the axes.
class Section {
 public:
  Section(const RobotFile& file, const RobotWorkspace& workspace, int across, int up, double left)
      : file_(file), robot_(*file.robot), across_(across), up_(up), left_(left) {
    robot_.kinematics(robot_.home_pose(), PlatformVector::Zero(robot_.dof()), home_);
    for (const int axis : {across, up}) {
      auto [low, high] = workspace.reach[static_cast<std::size_t>(axis)];
      for (int leg = 0; leg < robot_.legs(); ++leg) {
        const LegPoints& points = home_.legs[static_cast<std::size_t>(leg)];
        for (const CartesianVector* point :
             {&points.base_joint, &points.passive_joint, &points.coupling_joint}) {
          low = std::min(low, (*point)[axis]);
          high = std::max(high, (*point)[axis]);
        }
      }
      range_.push_back({low, high});
    }
    scale_ = width / std::max(range_[0][1] - range_[0][0], range_[1][1] - range_[1][0]);
  }

  double right() const { return x(range_[0][1]) + margin; }
  double bottom() const { return y(range_[1][0]) + margin; }

  std::string svg() const {
    std::string text;
    const double side = width / cells;
    const double step = side / scale_;
    const PoseCheck check(robot_, file_.limits);
    for (double b = range_[1][0] + 0.5 * step; b < range_[1][1]; b += step) {
      for (double a = range_[0][0] + 0.5 * step; a < range_[0][1]; a += step) {
        const WorkspacePose there = check.at(pose(a, b));
        if (!there.reachable) continue;
        text += fmt::format("<rect x='{:.1f}' y='{:.1f}' width='{:.1f}' height='{:.1f}' fill='{}'/>\n",
                            x(a) - 0.5 * side, y(b) - 0.5 * side, side + 0.3, side + 0.3, colour_of(there));
      }
    }
    return text + drawn_robot() + axes();
  }

 private:
  double x(double a) const { return left_ + margin + scale_ * (a - range_[0][0]); }
  double y(double b) const { return margin + scale_ * (range_[1][1] - b); }

  Configuration pose(double a, double b) const {
    PlatformVector away = PlatformVector::Zero(robot_.dof());
    away[across_] = a - robot_.home_pose()[across_];
    away[up_] = b - robot_.home_pose()[up_];
    return robot_.space().plus(robot_.home_pose(), away);
  }

  std::string point(const CartesianVector& p) const {
    return fmt::format("{:.1f},{:.1f} ", x(p[across_]), y(p[up_]));
  }
  std::string drawn_robot() const {
    std::string text, platform;
    for (int leg = 0; leg < robot_.legs(); ++leg) {
      const LegPoints& points = home_.legs[static_cast<std::size_t>(leg)];
      text += "<polyline class='leg' points='" + point(points.base_joint) + point(points.passive_joint) +
              point(points.coupling_joint) + "'/>\n";
      text += fmt::format("<circle class='base' cx='{:.1f}' cy='{:.1f}' r='4'/>\n",
                          x(points.base_joint[across_]), y(points.base_joint[up_]));
      platform += point(points.coupling_joint);
    }
    return text + "<polygon class='platform' points='" + platform + "'/>\n";
  }
  std::string axes() const {
    static constexpr std::array names = {"x", "y", "z"};
    std::string text;
    const auto label = [&](double at_x, double at_y, const char* anchor, const std::string& what) {
      text +=
          fmt::format("<text x='{:.1f}' y='{:.1f}' text-anchor='{}'>{}</text>\n", at_x, at_y, anchor, what);
    };
    const double low = y(range_[1][0]) + 18.0;
    for (const double a : {range_[0][0], range_[0][1]})
      label(x(a), low, "middle", fmt::format("{:.0f}", 1e3 * a));
    for (const double b : {range_[1][0], range_[1][1]})
      label(x(range_[0][0]) - 6.0, y(b) + 4.0, "end", fmt::format("{:.0f}", 1e3 * b));
    label(0.5 * (x(range_[0][0]) + x(range_[0][1])), low, "middle",
          fmt::format("{} [mm]", names[static_cast<std::size_t>(across_)]));
    label(x(range_[0][0]) - 6.0, 0.5 * (y(range_[1][0]) + y(range_[1][1])), "end",
          fmt::format("{}", names[static_cast<std::size_t>(up_)]));
    return text;
  }

  const RobotFile& file_;
  const ParallelRobot& robot_;
  int across_, up_;
  double left_;
  std::vector<std::array<double, 2>> range_;
  double scale_ = 1.0;
  Kinematics home_;
};

std::string legend(double left, double top) {
  struct Entry {
    const char* colour;
    const char* what;
  };
  std::string text;
  for (const Entry& entry : {Entry{"#d6ecde", "condition number 1"}, Entry{"#184e5c", "20"},
                             Entry{"#d4d7dc", "beyond a limit"}, Entry{"#e8b4ae", "behind a singularity"}}) {
    text += fmt::format(
        "<rect x='{:.1f}' y='{:.1f}' width='14' height='14' fill='{}'/>"
        "<text x='{:.1f}' y='{:.1f}'>{}</text>\n",
        left, top, entry.colour, left + 20.0, top + 12.0, entry.what);
    left += 40.0 + 7.0 * static_cast<double>(std::string(entry.what).size());
  }
  return text;
}

}  // namespace

std::string workspace_picture(const RobotFile& file) {
  const RobotWorkspace workspace = robot_workspace(*file.robot, file.limits);
  std::vector<Section> sections;
  sections.emplace_back(file, workspace, 0, 1, 0.0);
  if (file.robot->space().translations() == 3)
    sections.emplace_back(file, workspace, 0, 2, sections.front().right());
  double bottom = 0.0;
  std::string drawn;
  for (const Section& section : sections) {
    bottom = std::max(bottom, section.bottom());
    drawn += section.svg();
  }
  const double right = std::max(sections.back().right(), 560.0);
  return fmt::format(
             "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 {0:.0f} {1:.0f}' width='{0:.0f}' "
             "height='{1:.0f}' font-family='sans-serif' font-size='12'>\n"
             "<title>Workspace of {2}</title>\n<rect width='100%' height='100%' fill='white'/>\n"
             "<style>.leg{{fill:none;stroke:#333;stroke-width:3;stroke-linejoin:round;opacity:.75}}"
             ".base{{fill:#333}}.platform{{fill:none;stroke:#333;stroke-width:1.5}}</style>\n",
             right, bottom + 30.0, escaped(file.robot->name())) +
         drawn + legend(margin, bottom) + "</svg>\n";
}

}  // namespace flinch
