#pragma once

#include <string>

namespace flinch {

/// Names one rigid body of a fully-parallel robot: the platform, or the first (proximal) or second (distal)
/// link of a leg. Legs count from 0 in code and from 1 in names.
///
/// Body frames: the platform has frame E; a link has its origin on its proximal joint and its x axis along
/// the link towards the distal joint.
class BodyId {
 public:
  /// The platform.
  constexpr BodyId() = default;

  static constexpr BodyId platform() { return BodyId(0); }
  static constexpr BodyId link1(int leg) { return BodyId(1 + 2 * leg); }
  static constexpr BodyId link2(int leg) { return BodyId(2 + 2 * leg); }

  /// Inverse of `index()`; 0 <= index < 1 + 2 legs.
  static constexpr BodyId from_index(int index) { return BodyId(index); }

  /// Position in the order platform, leg1_link1, leg1_link2, leg2_link1, ...
  constexpr int index() const { return index_; }

  constexpr bool is_platform() const { return index_ == 0; }
  constexpr bool is_link1() const { return index_ % 2 == 1; }
  constexpr bool is_link2() const { return index_ > 0 && index_ % 2 == 0; }

  /// Leg that the link belongs to, from 0; -1 for the platform.
  constexpr int leg() const { return is_platform() ? -1 : (index_ - 1) / 2; }

  friend constexpr bool operator==(BodyId, BodyId) = default;

 private:
  explicit constexpr BodyId(int index) : index_(index) {}

  int index_ = 0;
};

/// "platform", "leg1_link1", "leg1_link2", "leg2_link1", ...
std::string body_name(BodyId body);

}  // namespace flinch
