#include "systems/robot/legs/home_assembly.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <sstream>

#include "systems/foundation/findings.h"
#include "systems/robot/angles.h"
#include "systems/robot/decompositions.h"
#include "systems/robot/legs/legs_assembly.h"
#include "systems/robot/legs/legs_dynamics.h"
#include "systems/robot/legs/rest_factor.h"

namespace flinch {
namespace {

constexpr double degrees = 180.0 / std::numbers::pi;
constexpr double farthest_angle = 30.0 / degrees;  // of a joint at home from its reference
constexpr double farthest_length = 0.25;           // and of one that slides, in characteristic lengths
constexpr double largest_gap = 1e-6;           // by which closures may stay open where the platform moves [m]
constexpr double least_singular_value = 1e-7;  // of the largest: smaller is a motion that nothing holds
constexpr double largest_condition_number = 1e6;
constexpr int samples = 64;

std::string path_of(std::size_t leg) { return "legs[" + std::to_string(leg) + "]"; }

/// One coordinate of a leg, as its description names it.
struct NamedCoordinate {
  std::string joint;
  bool slides = false;
};

std::vector<NamedCoordinate> named_coordinates(const RobotLeg& leg) {
  std::vector<NamedCoordinate> names;
  for (const LegJoint& joint : leg.joints) {
    if (joint.follows) continue;
    for (int i = 0; i < axis_count(joint.kind); ++i) names.push_back({joint.name, slides(joint.kind)});
  }
  return names;
}

int rank(const Eigen::MatrixXd& matrix) {
  if (matrix.size() == 0) return 0;
  const Eigen::VectorXd values = matrix.jacobiSvd().singularValues();
  return static_cast<int>((values.array() > least_singular_value * std::max(values[0], 1e-12)).count());
}

class HomeAssembly {
 public:
  HomeAssembly(const LegsParameters& parameters, LegsModel& model) : parameters_(parameters), model_(model) {
    for (std::size_t i = 0; i < model.legs.size(); ++i) references_.s[i] = model.legs[i].home;
  }

  std::vector<std::string> run() {
    begin_following();
    for (std::size_t i = 0; i < model_.legs.size(); ++i) check_rank(i, references_);
    if (findings_.none()) close();
    if (findings_.none()) set_determinants();
    if (findings_.none()) check_motion();
    if (findings_.none()) check_drives();
    return findings_.take();
  }

 private:
  std::size_t count() const { return model_.legs.size(); }

  // They start where home_pose says.
  void begin_following() {
    const ChartNumbers home = model_.home_chart();
    model_.home_following.resize(0);
    for (int i = 0; i < 6; ++i) {
      if (model_.moves.roles[static_cast<std::size_t>(i)] != ChartRole::follows) continue;
      model_.home_following.conservativeResize(model_.home_following.size() + 1);
      model_.home_following[model_.home_following.size() - 1] = home[i];
    }
    references_.z = model_.home_following;
  }

  Eigen::MatrixXd closure_matrix(std::size_t i, const LegsState& state) const {
    ChainPlace place;
    ClosureMatrix J;
    model_.legs[i].chain.place(state.s[i], place);
    model_.legs[i].matrix(place, J);
    return J;
  }

  // Everywhere but at singularities it is the number of coordinates; the references may stand in one, so that
  // it is also looked at beside them.
  void check_rank(std::size_t i, const LegsState& state) {
    const int k = model_.legs[i].chain.coordinates;
    int found = rank(closure_matrix(i, state));
    LegsState beside = state;
    for (int j = 0; j < k; ++j) beside.s[i][j] += 0.1 + 0.03 * j;
    found = std::max(found, rank(closure_matrix(i, beside)));
    if (found == k) return;
    findings_.add(path_of(i) + " can move while the platform stands still: " + std::to_string(k - found) +
                  (k - found == 1 ? " joint" : " joints") + " more than its closures hold");
  }

  double gap(std::size_t i, const ChartNumbers& chart, const LegsState& state) const {
    ChainPlace place;
    PlatformTwist platform;
    ClosureVector e;
    ChartNumbers whole = chart;
    int next = 0;
    for (int j = 0; j < 6; ++j) {
      if (model_.moves.roles[static_cast<std::size_t>(j)] == ChartRole::follows) whole[j] = state.z[next++];
    }
    model_.place(whole, platform);
    model_.legs[i].chain.place(state.s[i], place);
    model_.legs[i].residual(place, platform, e);
    return e.norm();
  }

  static std::string in_mm(double length) {
    std::ostringstream text;
    text.precision(3);
    text << 1e3 * length << " mm";
    return text.str();
  }

  void close() {
    home_ = references_;
    if (model_.following() > 0) {
      if (!approach(model_, {0, count()}, model_.home_chart(), home_)) return note_open_legs();
      for (std::size_t i = 0; i < count(); ++i) check_reference(i);
    } else {
      for (std::size_t i = 0; i < count(); ++i) close_leg(i);
    }
  }

  void note_open_legs() {
    for (std::size_t i = 0; i < count(); ++i) {
      const double open = gap(i, model_.home_chart(), home_);
      if (open > largest_gap) note_open(i, open);
    }
    if (findings_.none())
      findings_.add("home_pose is not found from the references of the joints; give references nearer to it");
  }

  void note_open(std::size_t i, double open) {
    findings_.add(path_of(i) + " does not reach home_pose: its closure stays open by " + in_mm(open));
  }

  void close_leg(std::size_t i) {
    ModelLeg& leg = model_.legs[i];
    leg.form = ClosedForm::of(leg.chain, leg.closures);
    if (leg.form && choose_assembly(i)) return;
    home_.z.resize(0);
    if (approach(model_, {i, i + 1}, model_.home_chart(), home_) && !leg.form) return check_reference(i);
    note_open(i, gap(i, model_.home_chart(), home_));
  }

  // The nearest to the references of the ways in which a closed form can be assembled.
  bool choose_assembly(std::size_t i) {
    ModelLeg& leg = model_.legs[i];
    PlatformTwist platform;
    model_.place(model_.home_chart(), platform);
    const Eigen::Vector3d target = platform.origin + platform.axes * leg.closures.front().on_at;
    double nearest = std::numeric_limits<double>::infinity();
    for (const double bend : {1.0, -1.0}) {
      for (const double turn : {1.0, -1.0}) {
        LegCoordinates s;
        if (!leg.form->solve(leg.chain, target, {bend, turn}, s)) continue;
        const double distance = distance_from_reference(i, s).sum();
        if (!(distance < nearest)) continue;
        nearest = distance;
        leg.assembly = {bend, turn};
        home_.s[i] = s;
      }
    }
    return std::isfinite(nearest);
  }

  // Of each coordinate, lengths in characteristic lengths.
  Eigen::VectorXd distance_from_reference(std::size_t i, const LegCoordinates& s) const {
    const std::vector<NamedCoordinate> names = named_coordinates(parameters_.legs[i]);
    Eigen::VectorXd distance(s.size());
    for (int j = 0; j < s.size(); ++j) {
      const double difference = s[j] - references_.s[i][j];
      distance[j] = names[static_cast<std::size_t>(j)].slides
                        ? std::abs(difference) / model_.characteristic_length
                        : std::abs(wrap_angle(difference));
    }
    return distance;
  }

  // Iteration from rough references may end in a working mode that nobody meant.
  void check_reference(std::size_t i) {
    const std::vector<NamedCoordinate> names = named_coordinates(parameters_.legs[i]);
    const Eigen::VectorXd distance = distance_from_reference(i, home_.s[i]);
    for (int j = 0; j < distance.size(); ++j) {
      const NamedCoordinate& name = names[static_cast<std::size_t>(j)];
      if (distance[j] <= (name.slides ? farthest_length : farthest_angle)) continue;
      std::ostringstream sentence;
      sentence.precision(3);
      sentence << path_of(i) << " closes at home_pose with '" << name.joint << "' at ";
      if (name.slides)
        sentence << home_.s[i][j] << " m, " << distance[j] * model_.characteristic_length << " m";
      if (!name.slides)
        sentence << wrap_angle(home_.s[i][j]) * degrees << " deg, " << distance[j] * degrees << " deg";
      sentence << " from its reference; give the reference that is meant";
      return findings_.add(sentence.str());
    }
    const ModelLeg& leg = model_.legs[i];
    if (!leg.is_square()) return;
    const double at_home = closure_matrix(i, home_).determinant();
    const double at_reference = closure_matrix(i, references_).determinant();
    if (at_home * at_reference < 0.0)
      findings_.add(path_of(i) +
                    " closes at home_pose on another side of a singularity than its references stand "
                    "on; give references nearer to the home pose");
  }

  void set_determinants() {
    model_.home_following = home_.z;
    PlatformTwist platform;
    model_.place(chart_with(home_.z), platform);
    RestFactor rest;
    rest.start(model_.following());
    for (std::size_t i = 0; i < count(); ++i) {
      ModelLeg& leg = model_.legs[i];
      leg.home = home_.s[i];
      for (const ChainJoint& joint : leg.chain.joints) check_range(i, joint);
      const Eigen::MatrixXd J = closure_matrix(i, home_);
      if (rank(J) < leg.chain.coordinates) {
        findings_.add(path_of(i) +
                      " stands in a singularity at home_pose: it can move while the platform stands still");
        return;
      }
      ClosureFactor factor;
      factor.compute(J);
      leg.home_determinant = factor.determinant();
      choose_side_rows(J, leg);
      if (model_.following() > 0) {
        ClosureMap P;
        leg.platform_map(platform, following_columns(), P);
        rest.add(factor, P);
      }
    }
    if (model_.following() > 0 && findings_.none()) set_rest_determinant(rest);
  }

  static void choose_side_rows(const Eigen::MatrixXd& J, ModelLeg& leg) {
    if (leg.is_square()) return;
    const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(J.transpose());
    Eigen::MatrixXd rows(leg.chain.coordinates, leg.chain.coordinates);
    for (int k = 0; k < leg.chain.coordinates; ++k) {
      leg.side_rows.push_back(qr.colsPermutation().indices()[k]);
      rows.row(k) = J.row(leg.side_rows.back());
    }
    leg.home_side = rows.determinant();
  }

  void check_range(std::size_t i, const ChainJoint& joint) {
    const double q = joint.slides ? joint.position(home_.s[i]) : wrap_angle(joint.position(home_.s[i]));
    if (q > joint.least && q < joint.most) return;
    std::ostringstream sentence;
    sentence << "does not reach home_pose: a joint would stand at ";
    if (joint.slides) sentence << q << " m";
    if (!joint.slides) sentence << q * degrees << " deg";
    sentence << ", outside of its range";
    findings_.add(path_of(i) + " " + sentence.str());
  }

  ChartNumbers chart_with(const FollowingVector& z) const {
    ChartNumbers chart = model_.home_chart();
    int next = 0;
    for (int j = 0; j < 6; ++j) {
      if (model_.moves.roles[static_cast<std::size_t>(j)] == ChartRole::follows) chart[j] = z[next++];
    }
    return chart;
  }

  PlatformTwist::Map following_columns() const {
    const Eigen::Matrix<double, 6, 6> X = chart_map(chart_with(home_.z));
    PlatformTwist::Map columns(6, 0);
    for (int j = 0; j < 6; ++j) {
      if (model_.moves.roles[static_cast<std::size_t>(j)] != ChartRole::follows) continue;
      columns.conservativeResize(Eigen::NoChange, columns.cols() + 1);
      columns.col(columns.cols() - 1) = X.col(j);
    }
    return columns;
  }

  void set_rest_determinant(RestFactor& rest) {
    const int d = model_.following();
    const Eigen::MatrixXd Z = rest.matrix();
    if (Z.rows() > max_rest_rows || rank(Z) < d) {
      const int open = d - rank(Z);
      findings_.add(
          "the legs leave the platform " + std::to_string(open) + (open == 1 ? " motion" : " motions") +
          " that `coordinates` neither frees nor fixes; its numbers that follow do not follow from the "
          "legs");
      return;
    }
    rest.factor();
    model_.home_rest_determinant = rest.rows() == d ? rest.determinant() : rest.size();
  }

  // Rows that are more than a leg's coordinates stay closed where the platform moves as it should.
  void check_motion() {
    std::mt19937 generator(1);
    std::uniform_real_distribution<double> uniform(-0.02, 0.02);  // within reach of a home worth the name
    const bool redundant = std::any_of(model_.legs.begin(), model_.legs.end(),
                                       [](const ModelLeg& leg) { return !leg.is_square(); });
    for (int sample = 0; redundant && sample < samples; ++sample) {
      ChartNumbers chart = model_.home_chart();
      for (int j = 0; j < 6; ++j) {
        const double moved = uniform(generator);
        if (model_.moves.roles[static_cast<std::size_t>(j)] != ChartRole::free) continue;
        chart[j] += j < 3 ? moved * model_.characteristic_length : moved;
      }
      LegsState state = home_;
      if (model_.following() > 0) {
        approach(model_, {0, count()}, chart, state);
      } else {
        for (std::size_t i = 0; i < count(); ++i) approach(model_, {i, i + 1}, chart, state);
      }
      for (std::size_t i = 0; i < count(); ++i) {
        const double open = gap(i, chart, state);
        if (!(open > largest_gap)) continue;
        findings_.add("the platform cannot move as `moves` says: it moves against " + path_of(i) +
                      ", whose closures open by " + in_mm(open));
        return;
      }
    }
  }

  void check_drives() {
    const int n = model_.moves.space.dimension();
    const ConfigurationSpace& space = model_.moves.space;
    LegsMotion motion;
    motion.set(model_, home_configuration(model_), PlatformVector::Zero(n), home_);
    PlatformMatrix A, dA;
    set_drive_map(model_, motion, A, dA);
    PlatformVector scale = PlatformVector::Ones(n);
    scale.tail(space.rotations()).setConstant(1.0 / model_.characteristic_length);
    const Eigen::MatrixXd scaled = A * scale.asDiagonal();
    const Eigen::JacobiSVD<Eigen::MatrixXd> svd(scaled, Eigen::ComputeThinV);
    const Eigen::VectorXd& values = svd.singularValues();
    if (!(values[n - 1] * largest_condition_number > values[0])) {
      Eigen::Index loose = 0;
      svd.matrixV().col(n - 1).cwiseAbs().maxCoeff(&loose);
      findings_.add("home_pose is singular: the drives do not hold " + name_of_coordinate(loose));
      return;
    }
    const Eigen::MatrixXd square =
        A.rows() == A.cols() ? Eigen::MatrixXd(A) : Eigen::MatrixXd(A.transpose() * A);
    model_.home_drive_determinant =
        A.rows() == A.cols() ? square.determinant() : std::sqrt(square.determinant());
    check_inertia(motion);
  }

  std::string name_of_coordinate(Eigen::Index free) const {
    Eigen::Index next = 0;
    for (std::size_t j = 0; j < 6; ++j) {
      if (model_.moves.roles[j] == ChartRole::free && next++ == free) return std::string(chart_names[j]);
    }
    return "a coordinate";
  }

  void check_inertia(const LegsMotion& motion) {
    LegsDynamics dynamics;
    dynamics.set(model_, motion);
    const Eigen::MatrixXd M = dynamics.M;
    if (M.llt().info() == Eigen::Success) return;
    Eigen::Index light = 0;
    M.jacobiSvd(Eigen::ComputeThinV).matrixV().rightCols<1>().cwiseAbs().col(0).maxCoeff(&light);
    findings_.add("platform: nothing has inertia along " + name_of_coordinate(light));
  }

  const LegsParameters& parameters_;
  LegsModel& model_;
  LegsState references_;
  LegsState home_;
  Findings findings_;
};

}  // namespace

Configuration home_configuration(const LegsModel& model) {
  Configuration pose = model.moves.space.origin();
  if (model.moves.whole_pose()) {
    const Eigen::Quaterniond q(model.home_axes);
    pose << model.home_position, q.w(), q.x(), q.y(), q.z();
    return pose;
  }
  int next = 0;
  for (int j = 0; j < 3; ++j) {
    if (model.moves.roles[static_cast<std::size_t>(j)] == ChartRole::free)
      pose[next++] = model.home_position[j];
  }
  if (model.moves.space.rotations() == 1) pose[next] = wrap_angle(model.home_angle);
  return pose;
}

std::vector<std::string> assemble_at_home(const LegsParameters& parameters, LegsModel& model) {
  return HomeAssembly(parameters, model).run();
}

}  // namespace flinch
