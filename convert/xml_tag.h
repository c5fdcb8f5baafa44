#pragma once

#include <Eigen/Geometry>
#include <string>

#include "systems/config/legs_text.h"

namespace flinch {

/// An element of XML as it is written: its name and its attributes, in their order.
class XmlTag {
 public:
  explicit XmlTag(const std::string& name) : text_("<" + name) {}

  XmlTag& word(const std::string& key, const std::string& value);
  template <class Vector>
  XmlTag& numbers(const std::string& key, const Vector& values) {
    std::string list;
    for (const double value : values) list += (list.empty() ? "" : " ") + yaml_number(value);
    return word(key, list);
  }
  XmlTag& number(const std::string& key, double value) { return word(key, yaml_number(value)); }
  XmlTag& number_unless_zero(const std::string& key, double value) {
    return value == 0.0 ? *this : number(key, value);
  }

  /// With children to follow; without.
  std::string open() const { return text_ + ">"; }
  std::string closed() const { return text_ + "/>"; }

 private:
  std::string text_;
};

/// `text` two blanks deeper for each level of `depth`, as a line.
std::string indented(std::size_t depth, const std::string& text);

/// The pose of a frame with this origin and these axes.
Eigen::Isometry3d pose_at(const Eigen::Vector3d& origin, const Eigen::Matrix3d& axes);

/// Joint or link of leg `leg`, counted from 0, as models name it: "leg1_shoulder".
std::string name_in_model(std::size_t leg, const std::string& joint);

}  // namespace flinch
