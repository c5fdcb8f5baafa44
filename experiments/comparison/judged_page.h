#pragma once

#include <map>
#include <string>
#include <vector>

#include "experiments/comparison/signal_drawing.h"
#include "experiments/recorded/judged_log.h"
#include "systems/framework/recording.h"

namespace flinch {

/// What a page says besides of a log.
struct JudgedFacts {
  std::string name;                       ///< of the log
  std::string told;                       ///< how long it is, and by whose control path it was judged
  std::string estimator;                  ///< that is followed, whose wrench is "wrench"
  std::map<std::string, double> at_most;  ///< of each detector, false alarms an hour
  std::vector<std::string> events;        ///< faults and folds, a sentence each
  std::string call;                       ///< the command that judged it
};

/// One HTML page that needs nothing else: what was detected by whom, when by the user's words there was or
/// was not a contact, and what estimators made of the log, on one time cursor. The signals come in parts,
/// so that a long log is never whole in memory.
class JudgedPage {
 public:
  /// `first`, `last`: of the log, `period` of the control path [s].
  JudgedPage(double first, double last, double period);

  /// Whether a signal is drawn. What an estimator or detector says is drawn with all others of its kind.
  static bool shows(const std::string& path);
  /// To be called with all that judge_log() lets one see of those.
  void see(const Recording& latest);
  std::string html(const JudgedLog& judged, const LogTruth& truth, const JudgedFacts& facts) const;

 private:
  nlohmann::ordered_json charts(const std::vector<std::string>& sources) const;
  nlohmann::ordered_json lanes(const JudgedLog& judged, const LogTruth& truth) const;

  ChartAxis axis_;
  std::map<std::string, SignalDrawing> drawings_;  ///< by the signals' paths
};

}  // namespace flinch
