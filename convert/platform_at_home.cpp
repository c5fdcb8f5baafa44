#include "convert/platform_at_home.h"

#include "convert/xml_tag.h"

namespace flinch {

Eigen::Isometry3d platform_at_home(const LegsModel& model) {
  ChartNumbers chart = model.home_chart();
  Eigen::Index next = 0;
  for (std::size_t i = 0; i < 6; ++i) {
    if (model.moves.roles[i] == ChartRole::follows)
      chart[static_cast<Eigen::Index>(i)] = model.home_following[next++];
  }
  PlatformTwist home;
  model.place(chart, home);
  return pose_at(home.origin, home.axes);
}

}  // namespace flinch
