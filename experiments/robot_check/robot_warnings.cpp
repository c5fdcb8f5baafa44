#include "experiments/robot_check/robot_warnings.h"

#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>

#include "systems/foundation/quantity_text.h"
#include "systems/robot/contact_jacobian.h"
#include "systems/robot/parallel_robot.h"

namespace flinch {
namespace {

constexpr double steel = 7850.0;       // [kg/m^3]
constexpr double body_share = 0.25;    // of a robot's size: radius of a ball that no body of it fills
constexpr double far_outside = 2.0;    // of a robot's size: distance of a centre of mass
constexpr double alike_factor = 30.0;  // by which legs of one robot may differ
constexpr double least_size = 5e-3, largest_size = 50.0;  // of a robot [m]
constexpr double rounding = 1e-6;

/// The numbers of a robot file, by key.
struct FileNumber {
  std::string key, unit;
  std::vector<double> values;
  bool from_file = false;
};

std::vector<double> numbers_in(const std::string& text) {
  std::vector<double> values;
  const char* at = text.data();
  const char* const end = at + text.size();
  while (at < end) {
    double value = 0.0;
    const auto [next, error] = std::from_chars(at, end, value);
    if (error == std::errc()) {
      values.push_back(value);
      at = next;
    } else {
      ++at;
    }
  }
  return values;
}

class RobotWarnings {
 public:
  explicit RobotWarnings(const RobotFile& file) : file_(file) {
    for (const ReadValue& value : file.values) {
      if (!value.unit.empty())
        numbers_.push_back({value.key, value.unit, numbers_in(value.value), value.from_file});
    }
    file.robot->kinematics(file.robot->home_pose(), PlatformVector::Zero(file.robot->dof()), home_);
    for (int a = 0; a < file.robot->legs(); ++a) {
      const LegPoints& leg = home_.legs[static_cast<std::size_t>(a)];
      size_ = std::max({size_, (leg.base_joint - leg.coupling_joint).norm(),
                        (leg.passive_joint - leg.coupling_joint).norm()});
    }
  }

  std::vector<std::string> take() {
    doubt_size();
    for (const FileNumber& number : numbers_) doubt_angle(number);
    for (const FileNumber& number : numbers_) {
      if (number.key.ends_with("mass") && number.values.size() == 1 && number.values[0] > 0.0)
        doubt_body(number);
    }
    doubt_legs();
    doubt_hold();
    return std::move(warnings_);
  }

 private:
  void add(const std::string& key, const std::string& what) { warnings_.push_back(key + " " + what); }

  const FileNumber* find(const std::string& key) const {
    const auto found = std::find_if(numbers_.begin(), numbers_.end(),
                                    [&](const FileNumber& number) { return number.key == key; });
    return found == numbers_.end() ? nullptr : &*found;
  }

  void doubt_size() {
    if (size_ < least_size || size_ > largest_size) {
      warnings_.push_back(fmt::format(
          "the legs reach over {:.3g} m at home; check the units of the lengths (keys end in _m or _mm)",
          size_));
    }
  }

  // Zeros and offsets of encoders may well be several turns.
  void doubt_angle(const FileNumber& number) {
    if (number.unit != "rad" || !number.from_file) return;
    if (number.key.find("zero") != std::string::npos || number.key.find("offset") != std::string::npos)
      return;
    for (const double value : number.values) {
      if (std::abs(value) > 2.0 * std::numbers::pi * (1.0 + rounding))
        return add(number.key, "is " + quantity_text(value, "rad") + ", more than a turn; check its unit");
    }
  }

  void doubt_body(const FileNumber& mass) {
    const std::string body = mass.key.substr(0, mass.key.size() - std::string("mass").size());
    const double m = mass.values[0];
    const double radius = body_share * size_;
    const double most = steel * 4.0 / 3.0 * std::numbers::pi * radius * radius * radius;
    if (m > most) {
      add(mass.key,
          fmt::format("is {:.4g} kg, more than a ball of steel {:.2g} m wide, in a robot whose legs "
                      "reach over {:.2g} m; check its unit (keys end in _kg or _g)",
                      m, 2.0 * radius, size_));
    }
    if (const FileNumber* centre = find(body + "centre_of_mass")) {
      double squares = 0.0;
      for (const double x : centre->values) squares += x * x;
      if (std::sqrt(squares) > far_outside * size_) {
        add(centre->key, fmt::format("lies {:.3g} m away from the body's frame, in a robot whose legs reach "
                                     "over {:.2g} m; check its unit",
                                     std::sqrt(squares), size_));
      }
    }
    if (const FileNumber* inertia = find(body + "inertia")) doubt_inertia(*inertia, m);
  }

  void doubt_inertia(const FileNumber& inertia, double mass) {
    std::vector<double> moments = inertia.values;
    std::sort(moments.begin(), moments.end());
    if (moments.empty() || !(moments.back() > 0.0)) return;
    const double gyration = std::sqrt(moments.back() / mass);
    if (gyration > size_) {
      return add(inertia.key, fmt::format("and a mass of {:.4g} kg are those of a body with a radius of "
                                          "gyration of {:.3g} m, in a robot whose legs reach over {:.2g} m; "
                                          "it may be of another body, or in another unit",
                                          mass, gyration, size_));
    }
    // One that moves in the plane may have the moment about its normal alone.
    const bool is_of_space = moments.size() == 3 && moments[1] > 0.0;
    if (is_of_space && moments[0] + moments[1] < moments[2] * (1.0 - rounding)) {
      add(inertia.key, fmt::format("has a moment of {:.4g} kg m^2 that is more than the sum of the others, "
                                   "which no body has",
                                   moments[2]));
    }
  }

  /// Keys of one leg beside those of the others: "legs[2].link1_length".
  void doubt_legs() {
    std::map<std::string, std::vector<const FileNumber*>> alike;
    for (const FileNumber& number : numbers_) {
      if (number.values.size() != 1 || !(number.values[0] > 0.0) || !number.key.starts_with("legs["))
        continue;
      if (number.unit == "kg" || number.unit == "kg m^2" || number.unit == "m")
        alike[number.key.substr(number.key.find(']'))].push_back(&number);
    }
    for (auto& [key, legs] : alike) {
      if (legs.size() < 3) continue;
      const auto by_value = [](const FileNumber* a, const FileNumber* b) {
        return a->values[0] < b->values[0];
      };
      std::stable_sort(legs.begin(), legs.end(), by_value);
      const double median = legs[legs.size() / 2]->values[0];
      for (const FileNumber* of : {legs.front(), legs.back()}) {
        const double factor = of->values[0] / median;
        if (factor > alike_factor || factor < 1.0 / alike_factor) {
          add(of->key, "is " + quantity_text(of->values[0], of->unit) + ", of other legs " +
                           quantity_text(median, of->unit) + "; check its unit");
        }
      }
    }
  }

  void doubt_hold() {
    Dynamics dynamics;
    file_.robot->dynamics(home_, dynamics);
    if (!home_.valid || !dynamics.valid) return;
    const double most = drive_torques(home_, dynamics.g_x).cwiseAbs().maxCoeff();
    if (!(most > file_.drives.max_torque)) return;
    const bool turns = file_.robot->drive_kind(0) == DriveKind::revolute;
    add(turns ? "drives.max_torque" : "drives.max_force",
        fmt::format("is {:.4g} {}, and a drive needs {:.4g} {} to hold the robot at home; check the units of "
                    "masses and of this key",
                    file_.drives.max_torque, turns ? "Nm" : "N", most, turns ? "Nm" : "N"));
  }

  const RobotFile& file_;
  std::vector<FileNumber> numbers_;
  Kinematics home_;
  double size_ = 0.0;  ///< [m]
  std::vector<std::string> warnings_;
};

}  // namespace

std::vector<std::string> robot_warnings(const RobotFile& file) { return RobotWarnings(file).take(); }

}  // namespace flinch
