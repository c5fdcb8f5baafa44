#include "systems/contact/evidence_features.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace flinch {
namespace {

constexpr double least_log = -12.0;
constexpr double usual_speed = 0.3;  // [m/s]

/// The numbers of one class.
class Column {
 public:
  Column(NeuralNetwork::Values& columns, int number) : columns_(columns), number_(number) {}
  void add(double value) { columns_(row_++, number_) = std::isfinite(value) ? value : 0.0; }

 private:
  NeuralNetwork::Values& columns_;
  int number_;
  Eigen::Index row_ = 0;
};

/// What the evidence says of one class, in numbers of similar size.
struct Seen {
  double log_share = least_log;  ///< ln of its probability, were all equally likely before
  double residual = 0.0;         ///< root of e^T S^-1 e
  double location = 0.0, force = 0.0, approach = 0.0;
};

double logarithm_of_sum(const ClassVector& logarithms) {
  const double top = logarithms.maxCoeff();
  return top + std::log((logarithms.array() - top).exp().sum());
}

Seen seen(const ContactEvidence& evidence, double all, int number) {
  return {std::max(evidence.log_evidence[number] - all, least_log),
          std::min(std::sqrt(evidence.residual[number]), 10.0), evidence.location[number],
          std::asinh(evidence.force[number] / 10.0),
          std::clamp(evidence.approach[number] / usual_speed, -5.0, 5.0)};
}

/// First link, second link and gap of a leg.
using LegClasses = std::array<int, 3>;
LegClasses classes_of_leg(const ContactClasses& classes, int leg) {
  return {BodyId::link1(leg).index(), BodyId::link2(leg).index(), classes.clamping(leg)};
}

/// The leg that the class belongs to; of the platform, the one whose classes are most likely.
int leg_beside(const ContactClasses& classes, const ContactEvidence& evidence, int number) {
  if (classes.leg(number) >= 0) return classes.leg(number);
  int best = 0;
  double highest = -INFINITY;
  for (int leg = 0; leg < classes.legs(); ++leg) {
    for (const int other : classes_of_leg(classes, leg)) {
      if (evidence.log_evidence[other] <= highest) continue;
      highest = evidence.log_evidence[other];
      best = leg;
    }
  }
  return best;
}

/// What one evidence says of a class and of those beside it.
void add_evidence(const ContactClasses& classes, const ContactEvidence& evidence, int number,
                  Column& column) {
  const double all = logarithm_of_sum(evidence.log_evidence);
  const LegClasses leg = classes_of_leg(classes, leg_beside(classes, evidence, number));
  for (const int other : {number, leg[0], leg[1], leg[2], 0}) {
    const Seen of = seen(evidence, all, other);
    column.add(of.log_share);
    column.add(of.residual);
    column.add(of.approach);
    column.add(of.location);
    column.add(of.force);
  }
  double best = least_log;
  for (int other = 0; other < classes.count(); ++other) {
    if (other != number) best = std::max(best, evidence.log_evidence[other] - all);
  }
  column.add(best);
  column.add(std::min(std::sqrt(evidence.residual.minCoeff()), 10.0));
}

/// How the contact has come about, as a leg has felt it.
void add_course(const LegHistory& course, Column& column) {
  for (const LegMoment& moment : course.moments) {
    for (const double force : {moment.link1_force, moment.link2_force, moment.other_force})
      column.add(std::asinh(force / 5.0));
    for (const double speed : {moment.link1_speed, moment.link2_speed})
      column.add(std::clamp(speed / usual_speed, -5.0, 5.0));
  }
  column.add(course.elbow_cosine);
}

}  // namespace

void evidence_features(const ContactClasses& classes, const SeenContact& seen,
                       NeuralNetwork::Values& columns) noexcept {
  const int count = std::min(classes.count(), NeuralNetwork::max_rows);
  const std::array all = {&seen.whole, &seen.growth};
  columns.setZero(evidence_feature_count, count);
  for (const ContactEvidence* each : all) {
    if (!each->valid || each->log_evidence.size() != classes.count()) return;
  }
  for (int number = 0; number < count; ++number) {
    Column column(columns, number);
    const bool is_platform = number == 0, is_clamping = classes.is_clamping(number);
    const bool is_link1 = !is_platform && !is_clamping && ContactClasses::body(number).is_link1();
    for (const bool is : {is_platform, is_link1, !is_platform && !is_clamping && !is_link1, is_clamping})
      column.add(is ? 1.0 : 0.0);
    for (const ContactEvidence* each : all) add_evidence(classes, *each, number, column);
    column.add(std::asinh(seen.force / 10.0));
    add_course(seen.courses[static_cast<std::size_t>(leg_beside(classes, seen.whole, number))], column);
  }
}

std::vector<FeatureName> evidence_feature_names() {
  std::vector<FeatureName> names;
  const auto add = [&names](const std::string& name) { names.push_back({name, "1"}); };
  for (const char* is : {"is_platform", "is_link1", "is_link2", "is_clamping"}) add(is);
  for (const std::string when : {"", "growth_"}) {
    for (const std::string of : {"own_", "link1_", "link2_", "clamping_", "platform_"}) {
      for (const char* what : {"log_share", "residual", "approach", "location", "log_force"})
        add(when + of + what);
    }
    for (const char* what : {"best_of_others", "least_residual"}) add(when + what);
  }
  add("log_total_force");
  for (const Time age : window_ages) {
    const std::string when = "_" + std::to_string(age / 1ms) + "ms_ago";
    for (const char* what : {"link1_force", "link2_force", "other_force", "link1_speed", "link2_speed"})
      add(what + when);
  }
  add("elbow_cosine");
  return names;
}

}  // namespace flinch
