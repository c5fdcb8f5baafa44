#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace flinch {

/// Messages of one topic in an MCAP file.
struct McapChannel {
  std::uint16_t id = 0;
  std::string topic;     ///< "/joint_states"
  std::string encoding;  ///< of its messages, "cdr"
  std::string schema;    ///< name of their type, "sensor_msgs/msg/JointState"
};

/// Goes once through an MCAP file [mcap.dev, MCAP Format Specification], whose chunks may be compressed by
/// LZ4 or Zstandard: `on_channel` for each channel before its first message, `on_message` for each message
/// with its channel, the time at which it was logged [ns], and its bytes.
///
/// Returns what was wrong with the file and did not keep it from being read: one that ends too early, as a
/// killed writer leaves it, is read as far as it goes. Throws SetupError for what is damaged, which does not
/// name the file.
std::vector<std::string> read_mcap(const std::filesystem::path& file,
                                   const std::function<void(const McapChannel&)>& on_channel,
                                   const std::function<void(std::uint16_t channel, std::uint64_t logged_ns,
                                                            std::string_view bytes)>& on_message);

bool is_mcap(const std::filesystem::path& file);

}  // namespace flinch
