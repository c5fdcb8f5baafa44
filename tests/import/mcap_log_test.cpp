#include "import/mcap_log.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "tests/support/mcap_bytes.h"
#include "tests/support/problems_of.h"
#include "tests/support/temporary_folder.h"

namespace flinch {
namespace {

using test::CdrMessage;
using test::mcap_channel;
using test::mcap_chunk;
using test::mcap_file;
using test::mcap_message;
using test::mcap_schema;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::IsNan;

class Bags : public testing::Test {
 protected:
  std::filesystem::path file(const std::string& bytes) const {
    std::ofstream(folder_ / "some.mcap", std::ios::binary) << bytes;
    return folder_ / "some.mcap";
  }
  std::vector<std::string> problems(const std::string& bytes) const {
    const auto path = file(bytes);
    return test::problems_of([&] { open_log(path); });
  }

 private:
  test::TemporaryFolder folder_;
};

std::vector<double> values_of(LogFile& log, const std::string& name) {
  const std::vector<std::size_t> wanted = {log.find(name)};
  return log.read(wanted).front();
}

using Texts = std::vector<std::string>;
using Numbers = std::vector<double>;

std::string joints(std::int32_t seconds, std::uint32_t nanoseconds, const Texts& names,
                   const Numbers& positions, const Numbers& efforts = {}) {
  return CdrMessage(seconds, nanoseconds).add(names).add(positions).add(Numbers()).add(efforts).bytes();
}

std::string imu(double angular_velocity, double linear_acceleration) {
  CdrMessage message(7, 5);
  for (int i = 0; i < 4 + 9; ++i) message.add(0.5);
  message.add(0.0).add(0.0).add(angular_velocity);
  for (int i = 0; i < 9; ++i) message.add(0.5);
  return message.add(linear_acceleration).add(0.0).add(9.81).bytes();
}

std::string two_topics() {
  return mcap_schema(1, "sensor_msgs/msg/JointState") + mcap_channel(3, 1, "/joint_states") +
         mcap_message(3, 100, joints(1'700'000'000, 123'456'789, {"a", "b"}, {0.1, 0.2}, {3.0, 4.0})) +
         mcap_schema(2, "sensor_msgs/msg/Imu") + mcap_channel(4, 2, "/imu") +
         mcap_message(4, 150, imu(2.0, 1.5)) +
         mcap_message(3, 200, joints(1'700'000'000, 124'456'789, {"b", "a"}, {0.4, 0.3}));
}

TEST_F(Bags, HaveATableForEachTopicAndAColumnForEachJoint) {
  for (const std::string& records : {two_topics(), mcap_chunk(two_topics(), ""),
                                     mcap_chunk(two_topics(), "lz4"), mcap_chunk(two_topics(), "zstd")}) {
    const auto log = open_log(file(mcap_file(records)));
    EXPECT_THAT(values_of(*log, "/joint_states/position[a]"), ElementsAre(0.1, 0.3));
    EXPECT_THAT(values_of(*log, "/joint_states/position[b]"), ElementsAre(0.2, 0.4));
    EXPECT_THAT(values_of(*log, "/joint_states/effort[b]"), ElementsAre(4.0, IsNan()));
    EXPECT_THAT(values_of(*log, "/imu/angular_velocity.z"), ElementsAre(2.0));
    EXPECT_THAT(values_of(*log, "/imu/linear_acceleration.x"), ElementsAre(1.5));
    EXPECT_THAT(values_of(*log, "/imu/linear_acceleration.z"), ElementsAre(9.81));
    EXPECT_THAT(log->remarks(), IsEmpty());
  }
}

TEST_F(Bags, KeepInstantsExact) {
  const auto log = open_log(file(mcap_file(two_topics())));
  EXPECT_THAT(log->read_instants(log->find("/joint_states/stamp"), ClockUnit::ns),
              ElementsAre(1'700'000'000'123'456'789, 1'700'000'000'124'456'789));
  EXPECT_THAT(log->read_instants(log->find("/joint_states/logged"), ClockUnit::ns), ElementsAre(100, 200));
}

TEST_F(Bags, HoldWrenches) {
  CdrMessage wrench(1, 2);
  for (const double number : {1.0, 2.0, 3.0, 0.1, 0.2, 0.3}) wrench.add(number);
  const auto log =
      open_log(file(mcap_file(mcap_schema(1, "geometry_msgs/msg/WrenchStamped") +
                              mcap_channel(0, 1, "/wrench") + mcap_message(0, 5, wrench.bytes()))));
  EXPECT_THAT(values_of(*log, "/wrench/force.y"), ElementsAre(2.0));
  EXPECT_THAT(values_of(*log, "/wrench/torque.z"), ElementsAre(0.3));
}

TEST_F(Bags, TakeEitherOrderOfBytes) {
  // A header of 1 s, 2 ns and "", then three forces of 1 and three torques of 0, the highest byte first.
  std::string big("\0\0\0\0\0\0\0\1\0\0\0\2\0\0\0\1\0\0\0\0", 20);
  for (int i = 0; i < 3; ++i) big += std::string("\x3f\xf0\0\0\0\0\0\0", 8);
  big += std::string(24, '\0');
  const auto log = open_log(file(mcap_file(mcap_schema(1, "geometry_msgs/msg/WrenchStamped") +
                                           mcap_channel(0, 1, "/wrench") + mcap_message(0, 5, big))));
  EXPECT_THAT(values_of(*log, "/wrench/force.x"), ElementsAre(1.0));
  EXPECT_THAT(log->read_instants(0, ClockUnit::ns), ElementsAre(1'000'000'002));
}

TEST_F(Bags, SayWhatTheyLeaveOut) {
  const auto camera =
      mcap_schema(9, "sensor_msgs/msg/Image") + mcap_channel(9, 9, "/camera") + mcap_message(9, 1, "pixels");
  EXPECT_THAT(open_log(file(mcap_file(camera + two_topics())))->remarks(),
              ElementsAre("topic '/camera' has messages 'sensor_msgs/msg/Image' as 'cdr'; left out"));
  EXPECT_THAT(problems(mcap_file(camera)), Contains(HasSubstr("holds no message of ROS 2 that is known")));
}

TEST_F(Bags, WhoseMessagesAreCutHaveNoNumbersThere) {
  const std::string whole = joints(1, 0, {"a", "b"}, {0.1, 0.2});
  const auto log = open_log(file(mcap_file(mcap_schema(1, "sensor_msgs/msg/JointState") +
                                           mcap_channel(3, 1, "/joint_states") + mcap_message(3, 100, whole) +
                                           mcap_message(3, 200, whole.substr(0, whole.size() - 20)))));
  EXPECT_THAT(values_of(*log, "/joint_states/position[b]"), ElementsAre(0.2, IsNan()));
  EXPECT_THAT(log->remarks(), ElementsAre(HasSubstr("1 of 2 messages are cut")));
}

TEST_F(Bags, OfKilledWritersAreReadAsFarAsTheyGo) {
  const std::string good = mcap_file(two_topics());
  const auto log = open_log(file(good.substr(0, good.size() - 60)));
  EXPECT_THAT(values_of(*log, "/imu/angular_velocity.z"), ElementsAre(2.0));
  EXPECT_THAT(log->remarks(), ElementsAre(HasSubstr("it ends too early")));
}

TEST_F(Bags, ThatAreDamagedAreRefusedWithTheReason) {
  std::string chunk = mcap_chunk(two_topics(), "");
  chunk[chunk.size() - 9] ^= 1;
  EXPECT_THAT(problems(mcap_file(chunk)), ElementsAre(HasSubstr("some.mcap: a chunk is damaged")));
  for (const char* const compression : {"lz4", "zstd"}) {
    std::string packed = mcap_chunk(two_topics(), compression);
    packed[packed.size() / 2] ^= 0x55;
    EXPECT_THAT(problems(mcap_file(packed)), ElementsAre(HasSubstr("is damaged")));
  }
  EXPECT_THAT(problems(mcap_file(mcap_chunk(two_topics(), "brotli"))),
              ElementsAre(HasSubstr("is compressed by 'brotli'; lz4 and zstd are known")));
  EXPECT_THAT(problems(mcap_file(mcap_message(3, 100, "x"))),
              ElementsAre(HasSubstr("belongs to no channel")));
}

TEST_F(Bags, EndInNoOtherWayWhateverIsWrittenOverThem) {
  const std::string good = mcap_file(two_topics());
  for (std::size_t at = 8; at < good.size(); ++at) {
    for (const char byte : {'\0', '\x7f', '\xff'}) {
      std::string bytes = good;
      bytes[at] = byte;
      EXPECT_NO_THROW(problems(bytes));
    }
  }
}

}  // namespace
}  // namespace flinch
