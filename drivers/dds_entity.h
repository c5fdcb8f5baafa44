#pragma once

#include <cstdint>
#include <string>
#include <utility>

namespace flinch {

/// Throws SetupError "<what>: <reason>" when `result`, of a call of Cyclone DDS, is an error; returns it
/// otherwise. For set-up only.
std::int32_t check_dds(std::int32_t result, const std::string& what);

/// Owns an entity of Cyclone DDS, and with it all that was made from it.
class DdsEntity {
 public:
  DdsEntity() = default;
  explicit DdsEntity(std::int32_t handle) : handle_(handle) {}
  DdsEntity(DdsEntity&& other) noexcept : handle_(std::exchange(other.handle_, 0)) {}
  DdsEntity& operator=(DdsEntity&& other) noexcept {
    std::swap(handle_, other.handle_);
    return *this;
  }
  ~DdsEntity();

  std::int32_t handle() const noexcept { return handle_; }

 private:
  std::int32_t handle_ = 0;
};

}  // namespace flinch
