#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "import/log_file.h"
#include "import/ros_messages.h"

namespace flinch {

/// A bag of ROS 2 as MCAP: each topic with messages of a known type is a table, its numbers are columns,
/// "/joint_states/position[shoulder]", "/imu/angular_velocity.x"; "/imu/stamp" is the time that the messages
/// tell, "/imu/logged" when they were logged, both in ns.
class McapLog final : public LogFile {
 public:
  /// Throws SetupError naming the file and what is missing or broken.
  explicit McapLog(const std::filesystem::path& file);

  std::vector<std::vector<double>> read(std::span<const std::size_t> wanted, std::size_t most_rows) override;
  std::vector<std::int64_t> read_instants(std::size_t column, ClockUnit unit, std::size_t most_rows) override;

 private:
  struct Topic {
    std::string name;
    std::unique_ptr<RosTable> table;
    std::vector<std::int64_t> logged;  ///< [ns]
  };
  /// Where a column lies.
  struct Place {
    enum class Kind { number, stamp, logged } kind = Kind::number;
    std::size_t topic = 0;
    std::size_t field = 0;
  };

  void read_file(const std::filesystem::path& file);
  void add_columns(std::size_t topic);
  const std::vector<std::int64_t>& instants(const Place& place) const;

  std::vector<Topic> topics_;
  std::vector<Place> places_;
};

}  // namespace flinch
