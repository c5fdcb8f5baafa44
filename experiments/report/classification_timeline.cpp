#include "experiments/report/classification_timeline.h"

#include <string>
#include <utility>
#include <vector>

#include "experiments/verdict/names_of_touched.h"

namespace flinch {

ClassificationTimeline::ClassificationTimeline(const ParallelRobot& robot, PageSamples& page) : page_(page) {
  std::vector<std::string> states = names_of_touched(robot);
  states.insert(states.begin(), "nothing");
  several_ = static_cast<int>(states.size());
  states.emplace_back("several contacts");
  lane_ = page.lane("taken for", std::move(states));
}

void ClassificationTimeline::show(const RecordedClassification& said, double weight) {
  const int taken = said.accepted ? said.most_likely + 1 : 0;
  const int state = said.several_contacts ? several_ : taken;
  page_.set_state(lane_, said.valid ? state : 0, weight);
}

}  // namespace flinch
