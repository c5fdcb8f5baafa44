#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "experiments/report/page_samples.h"
#include "systems/framework/recording.h"

namespace flinch::test {

/// What a page shows of a recording whose only lane is `Lane`, where so many samples are shown as one.
template <class Lane>
Report page_of(const Recording& recording, void (Lane::*drop_where_idle)(Report&) const,
               std::size_t together) {
  PageSamples page(together);
  Lane lane(recording, page);
  for (std::size_t k = 0; k < recording.samples(); ++k) {
    page.begin();
    lane.show(k);
  }
  Report report;
  page.finish(report);
  (lane.*drop_where_idle)(report);
  return report;
}

/// The state at each sample, by name.
inline std::vector<std::string> told(const Report& report) {
  std::vector<std::string> names;
  for (const int state : report.lanes.at(0).state)
    names.push_back(report.lanes.at(0).states.at(static_cast<std::size_t>(state)));
  return names;
}

}  // namespace flinch::test
