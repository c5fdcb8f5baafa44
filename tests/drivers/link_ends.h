#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "drivers/dds_server.h"
#include "drivers/dds_station.h"
#include "systems/framework/diagram_builder.h"
#include "systems/framework/monotonic_clock.h"
#include "systems/robot/planar_rrr.h"
#include "systems/robot/planar_rrr_presets.h"
#include "tests/drivers/far_robot.h"

/// The two ends of a link, each running its diagram every millisecond, late where the machine is busy.
namespace flinch::test {

inline constexpr std::uint32_t link_robot = 0x3333;

/// Ticks a diagram.
class Ticking {
 public:
  Ticking(std::unique_ptr<Diagram> diagram)
      : diagram_(std::move(diagram)), context_(diagram_->make_context()) {}

  const Diagram& diagram() const { return *diagram_; }
  const Context& context() const { return context_; }

  /// Runs ticks until `done`, which sees the outputs of each; `before_sending` is called once they are there.
  void run(
      Exchange& exchange, const std::function<bool()>& done,
      const std::function<void()>& before_sending = [] {}) {
    for (Time due = MonotonicClock::now();; due += 1ms) {
      MonotonicClock::sleep_until(due);
      while (MonotonicClock::now() >= due + 1ms) due += 1ms;  // lost periods, as RealtimeRunner counts them
      exchange.set_inputs(context_);
      diagram_->evaluate(context_);
      before_sending();
      exchange.take_outputs(context_);
      const bool ended = done();
      diagram_->update(context_);
      context_.set_time(context_.time() + 1ms);
      if (ended) return;
    }
  }

 private:
  std::unique_ptr<Diagram> diagram_;
  Context context_;
};

/// Has the robot.
class FarEnd {
 public:
  explicit FarEnd(const DdsBus& bus, std::uint32_t robot = link_robot, const std::string& name = "")
      : ticking_(build()), server_(bus, ticking_.diagram(), station_, {.robot = robot, .robot_name = name}) {}

  void run(
      const std::function<bool()>& done, const std::function<void()>& before_sending = [] {}) {
    ticking_.run(server_, done, before_sending);
  }
  const DdsServer& server() const { return server_; }
  const TorqueCommand& torque() const { return ticking_.context().get(station_.torque_command); }
  bool brake() const { return ticking_.context().get(station_.brake).engage; }

 private:
  std::unique_ptr<Diagram> build() {
    DiagramBuilder builder("far");
    auto& robot = builder.add<FarRobot>("robot");
    station_.torque_command = builder.export_input("torque_command", robot.torque_command);
    station_.brake = builder.export_input("brake", robot.brake);
    station_.joints = robot.joints;
    station_.drives = robot.drives;
    station_.imu = robot.imu;
    station_.status = robot.status;
    return builder.build();
  }

  Station station_;
  Ticking ticking_;
  DdsServer server_;
};

/// Commands it.
class NearEnd {
 public:
  explicit NearEnd(const DdsBus& bus, std::uint32_t robot = link_robot, const std::string& chosen = "")
      : ticking_(build()),
        dds_(bus, ticking_.diagram(), station_, {.robot = robot, .chosen_robot = chosen}) {}

  void run(const std::function<bool()>& done) { ticking_.run(dds_, done); }
  DdsStation& dds() { return dds_; }
  Time time() const { return ticking_.context().time(); }
  template <class Port>
  const auto& get(Port port) const {
    return ticking_.context().get(port);
  }
  const ExternalStation& station() const { return station_; }

 private:
  std::unique_ptr<Diagram> build() {
    DiagramBuilder builder("near");
    const auto robot = std::make_shared<PlanarRrr>(rig_robot(RigGeometry::individual, RigFriction::none));
    station_ = add_external_station(builder, robot, {.max_age = 20ms});
    auto& controller = builder.add<NearController>("controller");
    builder.connect(station_.joints, controller.joints);
    builder.connect(station_.status, controller.status);
    builder.connect(controller.torque_command, station_.torque_command);
    builder.connect(controller.brake, station_.brake);
    return builder.build();
  }

  ExternalStation station_;
  Ticking ticking_;
  DdsStation dds_;
};

/// Runs the far end on a thread of its own while it lives.
class FarThread {
 public:
  explicit FarThread(
      FarEnd& far, std::function<void()> each_tick = [] {})
      : thread_([this, &far, each_tick = std::move(each_tick)] {
          far.run([this, &each_tick] {
            each_tick();
            return ending_.load();
          });
        }) {}
  ~FarThread() {
    ending_ = true;
    thread_.join();
  }

 private:
  std::atomic<bool> ending_ = false;
  std::thread thread_;
};

}  // namespace flinch::test
