#include "diagrams/requested_fault.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "systems/foundation/setup_error.h"
#include "systems/robot/planar_rrr.h"
#include "systems/robot/planar_rrr_presets.h"

namespace flinch {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

const PlanarRrr& robot() {
  static const PlanarRrr rig(rig_robot(RigGeometry::nominal, RigFriction::none));
  return rig;
}

std::string complaint(const std::string& text) {
  try {
    parse_fault(text, robot());
  } catch (const SetupError& error) {
    return error.what();
  }
  return "";
}

TEST(RequestedFault, IsReadFromASentenceAndWrittenBack) {
  for (const char* const text :
       {"encoder2:drifting@0.5:-5", "encoders:delayed@1:0.01", "passive_encoder3:wrong@0:0.017",
        "currents:stuck@0.25", "current1:reversed@2", "gyroscope:off@1", "gyroscope3:noise@1:0.5",
        "accelerometer:scaled@0.1:2", "imu:delayed@0.5:0.02", "status:stuck@1", "drive1:stuck@0.6:50",
        "drives:scaled@0:0", "brakes:delayed@0:0.03", "brake2:off@0", "link:intermittent@1:0.3",
        "force_torque:wrong@1:10", "accelerometer:saturated@1:20", "imu2:turned@1:0.2"}) {
    EXPECT_EQ(text_of(parse_fault(text, robot())), text);
  }
  const RequestedFault fault = parse_fault("encoder2:drifting@0.5:-5", robot());
  EXPECT_EQ(fault.signal, FaultSignal::encoder);
  EXPECT_EQ(fault.index, 1);
  EXPECT_EQ(fault.kind, FaultKind::drifting);
  EXPECT_EQ(fault.begin, 500ms);
  EXPECT_EQ(fault.size, -5.0);
}

TEST(RequestedFault, SaysWhatIsWrongWithASentenceAndWhatWouldBeRight) {
  EXPECT_THAT(complaint("encoder2"), HasSubstr("SIGNAL:KIND@TIME[:SIZE]"));
  EXPECT_THAT(complaint("encodr2:off@1"), HasSubstr("did you mean 'encoder'?"));
  EXPECT_THAT(complaint("encoder2:of@1"), HasSubstr("did you mean 'off'?"));
  EXPECT_THAT(complaint("encoder4:off@1"), HasSubstr("encoder4: the numbers are 1 to 3"));
  EXPECT_THAT(complaint("encoder0:off@1"), HasSubstr("the numbers are 1 to 3"));
  EXPECT_THAT(complaint("imu1:off@1"), HasSubstr("there is one only"));
  EXPECT_THAT(complaint("encoder1:off@soon"), HasSubstr("the time 'soon' is no number"));
  EXPECT_THAT(complaint("encoder1:off@-1"), HasSubstr("between 0 and 3600 s"));
  EXPECT_THAT(complaint("encoder1:wrong@1"), HasSubstr("'wrong' needs a size"));
  EXPECT_THAT(complaint("encoder1:off@1:2"), HasSubstr("'off' has no size"));
  EXPECT_THAT(complaint("encoder1:noise@1:-1"), HasSubstr("must not be negative"));
  EXPECT_THAT(complaint("encoder1:delayed@1:1"), HasSubstr("between 0 and 0.06 s"));
  EXPECT_THAT(complaint("encoder1:intermittent@1:0"), HasSubstr("above 0 and at most 1"));
  EXPECT_THAT(complaint("link:stuck@1"), HasSubstr("it can be: off, delayed, intermittent"));
  EXPECT_THAT(complaint("brake1:reversed@1"), HasSubstr("it can be: off, stuck, scaled, delayed"));
  EXPECT_THAT(complaint("imu4:turned@1:0.1"), HasSubstr("the numbers are 1 to 3"));
  EXPECT_THAT(complaint("current1:saturated@1:-1"), HasSubstr("must not be negative"));
  EXPECT_THAT(complaint("imu:wrong@1:2"), HasSubstr("it cannot be 'wrong'"));
}

TEST(RequestedFault, OfWhatMovesCannotHappenToARecording) {
  const auto refused = [](const char* text) {
    return problems(parse_fault(text, robot()), FaultPlace{.moves = false});
  };
  EXPECT_THAT(refused("drive1:off@1"), ElementsAre(HasSubstr("a recording does not move")));
  EXPECT_THAT(refused("brakes:off@1"), ElementsAre(HasSubstr("a recording does not move")));
  EXPECT_THAT(refused("encoder1:off@1"), IsEmpty());
  EXPECT_THAT(refused("link:off@1"), IsEmpty());
  EXPECT_THAT(problems(parse_fault("drive1:off@1", robot()), FaultPlace()), IsEmpty());
}

TEST(RequestedFault, ThatWouldNeverShowIsRefused) {
  const FaultPlace place{.has_force_torque = false, .end = 1200ms};
  const auto refused = [&](const char* text) { return problems(parse_fault(text, robot()), place); };
  EXPECT_THAT(refused("force_torque:off@1"),
              ElementsAre(HasSubstr("force_torque: there is no such sensor; without an obstacle")));
  EXPECT_THAT(problems(parse_fault("passive_encoder2:off@1", robot()), {.has_passive_encoders = false}),
              ElementsAre("passive_encoder2: there are no passive encoders"));
  EXPECT_THAT(refused("link:off@2.3"),
              ElementsAre("link: it would begin at 2.3 s, but the run ends at 1.2 s"));
  EXPECT_THAT(refused("link:off@1.199"), IsEmpty());
  EXPECT_THAT(problems(parse_fault("force_torque:off@3600", robot()), FaultPlace()), IsEmpty());
  EXPECT_THROW(require_possible({parse_fault("force_torque:off@9", robot())}, place), SetupError);
}

}  // namespace
}  // namespace flinch
