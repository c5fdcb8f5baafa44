#include "import/ros_messages.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "import/byte_order.h"
#include "import/log_file.h"
#include "systems/foundation/setup_error.h"

namespace flinch {

/// Takes values from a message, each aligned to its size.
class RosTable::Cdr {
 public:
  explicit Cdr(std::string_view message) {
    if (message.size() < 4 || message[0] != 0 || (message[1] != 0 && message[1] != 1))
      throw SetupError("it is no plain CDR");
    is_big_ = message[1] == 0;
    content_ = message.substr(4);
  }

  std::uint32_t word() { return static_cast<std::uint32_t>(bits(4)); }
  double number() { return std::bit_cast<double>(bits(8)); }
  std::string text() {
    const std::uint32_t size = word();
    const std::string_view bytes = take(size, 1);
    return std::string(bytes.substr(0, bytes.find('\0')));
  }
  void skip_numbers(std::size_t count) { take(8 * count, 8); }
  std::vector<double> sequence() {
    const std::uint32_t count = word();
    if (count == 0) return {};
    if (count > content_.size() / 8) throw SetupError("it ends too early");
    std::vector<double> values(count);
    for (double& value : values) value = number();
    return values;
  }
  std::vector<std::string> texts() {
    const std::uint32_t count = word();
    if (count > content_.size() / 4) throw SetupError("it ends too early");
    std::vector<std::string> values(count);
    for (std::string& value : values) value = text();
    return values;
  }

 private:
  std::string_view take(std::size_t size, std::size_t alignment) {
    at_ = (at_ + alignment - 1) / alignment * alignment;
    if (at_ > content_.size() || size > content_.size() - at_) throw SetupError("it ends too early");
    const std::string_view taken = content_.substr(at_, size);
    at_ += size;
    return taken;
  }
  std::uint64_t bits(std::size_t size) { return number_of_bytes(take(size, size), is_big_); }

  std::string_view content_;
  std::size_t at_ = 0;
  bool is_big_ = false;
};

void RosTable::add(std::string_view bytes) {
  for (std::vector<double>& numbers : numbers_) numbers.push_back(std::nan(""));
  stamps_.push_back(no_instant);
  try {
    Cdr message(bytes);
    const auto seconds = static_cast<std::int32_t>(message.word());  // std_msgs/msg/Header
    const std::uint32_t nanoseconds = message.word();
    message.text();
    read(message);
    stamps_.back() = std::int64_t{seconds} * 1'000'000'000 + nanoseconds;
  } catch (const SetupError&) {
    for (std::vector<double>& numbers : numbers_) numbers.back() = std::nan("");
    ++damaged_;
  }
}

void RosTable::add_field(const std::string& name, const std::string& unit) {
  fields_.push_back({name, unit});
  numbers_.emplace_back(stamps_.size(), std::nan(""));
}

/// sensor_msgs/msg/JointState: joints are told by their names, in any order.
class JointStates final : public RosTable {
 private:
  void read(Cdr& message) override {
    const std::vector<std::string> names = message.texts();
    for (const char* const quantity : {"position", "velocity", "effort"}) {
      const std::vector<double> values = message.sequence();
      for (std::size_t i = 0; i < std::min(values.size(), names.size()); ++i)
        set(field_of(std::string(quantity) + "[" + names[i] + "]"), values[i]);
    }
  }

  std::size_t field_of(const std::string& name) {
    constexpr std::size_t most = 1000;
    std::size_t i = 0;
    while (i < fields().size() && fields()[i].name != name) ++i;
    if (i == most) throw SetupError("it has more joints than are read");
    if (i == fields().size()) add_field(name, "");
    return i;
  }
};

namespace {

constexpr std::array axes{".x", ".y", ".z"};

/// sensor_msgs/msg/Imu: orientation and covariances are not read.
class ImuSamples final : public RosTable {
 public:
  ImuSamples() {
    for (const char* const axis : axes) add_field(std::string("angular_velocity") + axis, "rad/s");
    for (const char* const axis : axes) add_field(std::string("linear_acceleration") + axis, "m/s^2");
  }

 private:
  void read(Cdr& message) override {
    message.skip_numbers(4 + 9);
    for (std::size_t i = 0; i < 3; ++i) set(i, message.number());
    message.skip_numbers(9);
    for (std::size_t i = 3; i < 6; ++i) set(i, message.number());
  }
};

/// geometry_msgs/msg/WrenchStamped
class Wrenches final : public RosTable {
 public:
  Wrenches() {
    for (const char* const axis : axes) add_field(std::string("force") + axis, "N");
    for (const char* const axis : axes) add_field(std::string("torque") + axis, "Nm");
  }

 private:
  void read(Cdr& message) override {
    for (std::size_t i = 0; i < 6; ++i) set(i, message.number());
  }
};

}  // namespace

std::unique_ptr<RosTable> ros_table(const std::string& type) {
  if (type == "sensor_msgs/msg/JointState") return std::make_unique<JointStates>();
  if (type == "sensor_msgs/msg/Imu") return std::make_unique<ImuSamples>();
  if (type == "geometry_msgs/msg/WrenchStamped") return std::make_unique<Wrenches>();
  return nullptr;
}

}  // namespace flinch
