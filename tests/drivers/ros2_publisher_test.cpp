#include "drivers/ros2_publisher.h"

#include <dds/dds.h>
#include <drivers/idl/ros2.h>
#include <gmock/gmock.h>

#include <thread>

#include "drivers/ros2_messages.h"
#include "drivers/topics.h"
#include "systems/foundation/setup_error.h"
#include "systems/framework/constant.h"
#include "systems/framework/diagram_builder.h"
#include "tests/support/free_domain.h"

namespace flinch {
namespace {

/// Reads messages as a program would that knows only the names and types of ROS 2.
template <class Message>
class Ros2Reader {
 public:
  Ros2Reader(const DdsBus& bus, const Topic& topic)
      : type_(topic.type),
        topic_(dds_create_topic(bus.participant(), topic.type, topic.name, nullptr, nullptr)),
        reader_(dds_create_reader(bus.participant(), topic_.handle(), nullptr, nullptr)) {}
  Ros2Reader(const Ros2Reader&) = delete;
  Ros2Reader& operator=(const Ros2Reader&) = delete;
  ~Ros2Reader() { dds_sample_free(&message, type_, DDS_FREE_CONTENTS); }

  /// Whether a message has come; it is then in `message`.
  bool take() {
    void* samples[1] = {&message};
    dds_sample_info_t info{};
    return dds_take(reader_.handle(), samples, &info, 1, 1) == 1 && info.valid_data;
  }

  Message message{};

 private:
  const dds_topic_descriptor_t* type_;
  DdsEntity topic_, reader_;
};

template <class Message>
bool wait_for(Ros2Reader<Message>& reader, const std::function<void()>& tick) {
  for (int attempt = 0; attempt < 5000; ++attempt) {
    tick();
    if (reader.take()) return true;
    std::this_thread::sleep_for(2ms);
  }
  return false;
}

const JointMotion joints{.acquired = 0ms,
                         .valid = true,
                         .position = Eigen::Vector3d(1, 2, 3),
                         .velocity = Eigen::Vector3d(4, 5, 6)};
const DriveTorque torque{.acquired = 0ms, .valid = true, .torque = Eigen::Vector3d(7, 8, 9)};
const ImuReading imu{
    .acquired = 0ms, .valid = true, .angular_velocity = {1, 2, 3}, .specific_force = {4, 5, 9.81}};
const WrenchEstimate wrench{
    .acquired = 0ms, .valid = true, .wrench_in_base = Eigen::Vector3d(10, 20, 3), .drive_torque = {}};

struct Shown {
  Ros2Sources sources;
  std::unique_ptr<Diagram> diagram;
};

Shown show() {
  DiagramBuilder builder;
  Shown shown;
  shown.sources.joint_motion = builder.add<Constant<JointMotion>>("joints", joints).value;
  shown.sources.drive_torque = builder.add<Constant<DriveTorque>>("torque", torque).value;
  shown.sources.imu = builder.add<Constant<ImuReading>>("imu", imu).value;
  shown.sources.wrench = builder.add<Constant<WrenchEstimate>>("wrench", wrench).value;
  shown.sources.gate = builder.add<Constant<GateStatus>>("gate", GateStatus()).value;
  shown.diagram = builder.build();
  return shown;
}

TEST(Ros2Publisher, PublishesWhatItsMessagesMean) {
  const DdsBus bus({.domain = test::free_domain()});
  const Shown shown = show();
  Context context = shown.diagram->make_context();
  Ros2Reader<sensor_msgs_msg_dds__JointState_> joint_states(bus, ros2_joint_states_topic);
  Ros2Reader<sensor_msgs_msg_dds__Imu_> imu_data(bus, ros2_imu_topic);
  Ros2Reader<geometry_msgs_msg_dds__WrenchStamped_> contact(bus, ros2_contact_wrench_topic);
  Ros2Reader<diagnostic_msgs_msg_dds__DiagnosticArray_> diagnostics(bus, ros2_diagnostics_topic);
  Ros2Publisher publisher(
      bus, *shown.diagram, shown.sources,
      {.joint_names = {"drive_1", "drive_2", "drive_3"}, .space = ConfigurationSpace::Kind::planar_pose});
  const auto tick = [&] {
    publisher.set_inputs(context);
    shown.diagram->evaluate(context);
    publisher.take_outputs(context);
    context.set_time(context.time() + 1ms);
  };

  ASSERT_TRUE(wait_for(joint_states, tick));
  const auto& state = joint_states.message;
  ASSERT_EQ(state.name_._length, 3u);
  EXPECT_STREQ(state.name_._buffer[2], "drive_3");
  EXPECT_EQ(state.position_._buffer[1], 2.0);
  EXPECT_EQ(state.velocity_._buffer[1], 5.0);
  EXPECT_EQ(state.effort_._buffer[1], 8.0);
  EXPECT_STREQ(state.header_.frame_id_, "base");
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  EXPECT_NEAR(state.header_.stamp_.sec_, std::chrono::duration<double>(now).count(), 30.0);

  ASSERT_TRUE(wait_for(imu_data, tick));
  EXPECT_EQ(imu_data.message.angular_velocity_.y_, 2.0);
  EXPECT_EQ(imu_data.message.linear_acceleration_.z_, 9.81);
  EXPECT_EQ(imu_data.message.orientation_covariance_[0], -1.0);

  ASSERT_TRUE(wait_for(contact, tick));
  EXPECT_EQ(contact.message.wrench_.force_.x_, 10.0);
  EXPECT_EQ(contact.message.wrench_.force_.y_, 20.0);
  EXPECT_EQ(contact.message.wrench_.torque_.z_, 3.0);

  ASSERT_TRUE(wait_for(diagnostics, tick));
  ASSERT_EQ(diagnostics.message.status_._length, 1u);
  EXPECT_EQ(diagnostics.message.status_._buffer[0].level_, 1);
  EXPECT_STREQ(diagnostics.message.status_._buffer[0].message_, "torque gate waiting");
}

TEST(Ros2Publisher, ShowsAllJointsOfAModelBesideTheDrives) {
  const DdsBus bus({.domain = test::free_domain()});
  DiagramBuilder builder;
  PlatformMotion motion;
  motion.status = PlatformMotion::Status::valid;
  motion.pose = Eigen::Vector3d(0.1, 0.2, 0.3);
  Ros2Sources sources;
  sources.motion = builder.add<Constant<PlatformMotion>>("motion", motion).value;
  const auto diagram = builder.build();
  Context context = diagram->make_context();
  Ros2Reader<sensor_msgs_msg_dds__JointState_> joint_states(bus, ros2_joint_states_topic);
  const auto find = [](const Configuration& pose, std::vector<double>& positions) {
    positions = {pose[0], 2.0 * pose[1]};
    return true;
  };
  Ros2Publisher publisher(bus, *diagram, sources,
                          {.joint_names = {},
                           .model = {{"platform_x", "leg1_elbow"}, find},
                           .space = ConfigurationSpace::Kind::planar_pose});
  ASSERT_TRUE(wait_for(joint_states, [&] {
    publisher.set_inputs(context);
    diagram->evaluate(context);
    publisher.take_outputs(context);
    context.set_time(context.time() + 1ms);
  }));
  const auto& state = joint_states.message;
  ASSERT_EQ(state.name_._length, 2u);
  EXPECT_STREQ(state.name_._buffer[1], "leg1_elbow");
  EXPECT_EQ(state.position_._buffer[1], 0.4);
  EXPECT_EQ(state.velocity_._length, 0u);
}

TEST(Ros2Messages, SayForceAndMomentOfEverySpace) {
  using Kind = ConfigurationSpace::Kind;
  const auto message_of = [](Kind space, const PlatformVector& in_base) {
    geometry_msgs_msg_dds__WrenchStamped_ message{};
    to_ros2(WrenchEstimate{.acquired = 0ms, .valid = true, .wrench_in_base = in_base, .drive_torque = {}},
            space, message);
    const auto& [f, m] = message.wrench_;
    return std::array{f.x_, f.y_, f.z_, m.x_, m.y_, m.z_};
  };
  EXPECT_EQ(message_of(Kind::plane, PlatformVector{{1, 2}}), (std::array<double, 6>{1, 2, 0, 0, 0, 0}));
  EXPECT_EQ(message_of(Kind::space, PlatformVector{{1, 2, 3}}), (std::array<double, 6>{1, 2, 3, 0, 0, 0}));
  EXPECT_EQ(message_of(Kind::planar_pose, PlatformVector{{1, 2, 3}}),
            (std::array<double, 6>{1, 2, 0, 0, 0, 3}));
  EXPECT_EQ(message_of(Kind::spatial_pose, PlatformVector{{1, 2, 3, 4, 5, 6}}),
            (std::array<double, 6>{1, 2, 3, 4, 5, 6}));
}

TEST(Ros2Publisher, CarriesTheNamesOfRos2OnTheBus) {
  EXPECT_STREQ(ros2_joint_states_topic.name, "rt/joint_states");
  EXPECT_STREQ(sensor_msgs_msg_dds__JointState__desc.m_typename, "sensor_msgs::msg::dds_::JointState_");
  EXPECT_STREQ(geometry_msgs_msg_dds__WrenchStamped__desc.m_typename,
               "geometry_msgs::msg::dds_::WrenchStamped_");
  EXPECT_STREQ(diagnostic_msgs_msg_dds__DiagnosticArray__desc.m_typename,
               "diagnostic_msgs::msg::dds_::DiagnosticArray_");
}

TEST(Ros2Publisher, RefusesToPublishMoreThanOnceATick) {
  const DdsBus bus({.domain = test::free_domain()});
  const Shown shown = show();
  EXPECT_THROW(
      Ros2Publisher(
          bus, *shown.diagram, shown.sources,
          {.joint_names = {}, .space = ConfigurationSpace::Kind::plane, .ticks_between_messages = 0}),
      SetupError);
}

}  // namespace
}  // namespace flinch
