#include "experiments/verdict/names_of_touched.h"

#include "systems/robot/alike_links.h"
#include "systems/signals/contact_classes.h"

namespace flinch {

std::vector<std::string> names_of_touched(const ParallelRobot& robot) {
  const ContactClasses classes(robot.body_count(), robot.legs());
  std::vector<std::string> names;
  for (int number = 0; number < classes.count(); ++number) names.push_back(classes.name(number));
  const std::vector<bool> alike = legs_of_alike_links(robot);
  for (int leg = 0; leg < robot.legs(); ++leg) {
    if (!alike[static_cast<std::size_t>(leg)]) continue;
    for (const BodyId link : {BodyId::link1(leg), BodyId::link2(leg)})
      names[static_cast<std::size_t>(ContactClasses::collision(link))] = "leg" + std::to_string(leg + 1);
  }
  return names;
}

bool names_body(const std::string& told, const std::string& body) {
  return told == body || body.starts_with(told + "_");
}

}  // namespace flinch
