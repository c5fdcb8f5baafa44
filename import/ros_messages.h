#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace flinch {

/// A number of a message.
struct RosField {
  std::string name;  ///< "position[shoulder]", "angular_velocity.x"
  std::string unit;  ///< "" where it depends on the joint
};

/// What messages of one type of ROS 2 hold, row by row: numbers, and the time in their header. They are read
/// from CDR [OMG Common Data Representation], in either order of bytes.
class RosTable {
 public:
  virtual ~RosTable() = default;

  const std::vector<RosField>& fields() const { return fields_; }
  const std::vector<std::vector<double>>& numbers() const { return numbers_; }  ///< of each field, NaN: none
  const std::vector<std::int64_t>& stamps() const { return stamps_; }           ///< [ns]
  std::size_t damaged() const { return damaged_; }                              ///< messages that were cut

  /// Appends a row; one that is cut has no numbers.
  void add(std::string_view message);

 protected:
  class Cdr;
  RosTable() = default;

  void add_field(const std::string& name, const std::string& unit);
  void set(std::size_t field, double value) { numbers_[field].back() = value; }

 private:
  /// What follows the header. Throws SetupError where the message ends too early.
  virtual void read(Cdr& message) = 0;

  std::vector<RosField> fields_;
  std::vector<std::vector<double>> numbers_;
  std::vector<std::int64_t> stamps_;
  std::size_t damaged_ = 0;
};

/// For sensor_msgs/msg/JointState, sensor_msgs/msg/Imu and geometry_msgs/msg/WrenchStamped; none: for others.
std::unique_ptr<RosTable> ros_table(const std::string& type);

}  // namespace flinch
