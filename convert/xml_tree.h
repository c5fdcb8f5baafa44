#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace flinch {

/// An element of an XML document, with what stands in it.
struct XmlElement {
  std::string name;
  std::string file;  ///< In which it stands.
  int line = 0;
  std::vector<std::pair<std::string, std::string>> attributes;
  std::string text;  ///< Between its tags, without white space around.
  std::vector<XmlElement> children;

  /// The first child of that name; null where there is none.
  const XmlElement* child(std::string_view child_name) const;
  std::vector<const XmlElement*> all(std::string_view child_name) const;
  /// Its value; nothing where there is none.
  std::optional<std::string> attribute(std::string_view attribute_name) const;

  // Each throws SetupError, with file and line, where what is said is not what was asked for.
  /// An attribute that must be there and say something.
  std::string required(std::string_view attribute_name) const;
  /// The finite numbers of an attribute; `otherwise` where there is none.
  double number(std::string_view attribute_name, double otherwise) const;
  Eigen::Vector3d vector(std::string_view attribute_name, const Eigen::Vector3d& otherwise) const;
  /// As many as there are, at most `most`.
  std::vector<double> numbers(std::string_view attribute_name, std::size_t most) const;
  /// The same of the text of a child.
  double number_in(std::string_view child_name, double otherwise) const;
  Eigen::Vector3d vector_in(std::string_view child_name, const Eigen::Vector3d& otherwise) const;
  std::vector<double> text_numbers(std::size_t most) const;

  /// "model.urdf:12: <joint>: is ..."
  [[noreturn]] void refuse(const std::string& complaint) const;
};

/// The element at the root of an XML document. Entities of the document's own are not expanded, and nothing
/// else is read. Throws SetupError, with `file` and line, where it is no XML, nests too deep or is too large.
XmlElement parse_xml(std::string_view text, const std::string& file);

}  // namespace flinch
