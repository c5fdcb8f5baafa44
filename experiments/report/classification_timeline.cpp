#include "experiments/report/classification_timeline.h"

#include <string>
#include <utility>
#include <vector>

namespace flinch {

ClassificationTimeline::ClassificationTimeline(const ContactClasses& classes, PageSamples& page)
    : classes_(classes), page_(page) {
  std::vector<std::string> states{"nothing"};
  for (int i = 0; i < classes.count(); ++i) states.push_back(classes.name(i));
  states.emplace_back("several contacts");
  lane_ = page.lane("taken for", std::move(states));
}

void ClassificationTimeline::show(const RecordedClassification& said, double weight) {
  const int taken = said.accepted ? said.most_likely + 1 : 0;
  const int state = said.several_contacts ? classes_.count() + 1 : taken;
  page_.set_state(lane_, said.valid ? state : 0, weight);
}

}  // namespace flinch
