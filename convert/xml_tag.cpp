#include "convert/xml_tag.h"

namespace flinch {
namespace {

/// A value of an attribute.
std::string escaped_word(const std::string& word) {
  std::string result;
  for (const char c : word) {
    if (c == '<') {
      result += "&lt;";
    } else if (c == '&') {
      result += "&amp;";
    } else {
      result += c == '"' ? "&quot;" : std::string(1, c);
    }
  }
  return result;
}

}  // namespace

XmlTag& XmlTag::word(const std::string& key, const std::string& value) {
  text_ += " " + key + "=\"" + escaped_word(value) + "\"";
  return *this;
}

std::string indented(std::size_t depth, const std::string& text) {
  return std::string(2 * depth, ' ') + text + "\n";
}

Eigen::Isometry3d pose_at(const Eigen::Vector3d& origin, const Eigen::Matrix3d& axes) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = origin;
  pose.linear() = axes;
  return pose;
}

std::string name_in_model(std::size_t leg, const std::string& joint) {
  return "leg" + std::to_string(leg + 1) + "_" + joint;
}

}  // namespace flinch
