#include "convert/xml_tree.h"

#include <tinyxml2.h>

#include <charconv>
#include <cmath>

#include "systems/foundation/setup_error.h"

namespace flinch {
namespace {

constexpr std::size_t largest_document = 16 << 20;  // [bytes]
constexpr std::size_t most_elements = 100'000;
constexpr int deepest = 50;              // of the parser's 100
constexpr double largest_number = 1e24;  // as in all files

std::string_view without_space(std::string_view text) {
  constexpr std::string_view space = " \t\r\n";
  const std::size_t begin = text.find_first_not_of(space);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(space) - begin + 1);
}

class XmlReader {
 public:
  explicit XmlReader(const std::string& file) : file_(file) {}

  XmlElement element(const tinyxml2::XMLElement& from, int depth) {
    XmlElement result;
    result.name = from.Name();
    result.file = file_;
    result.line = from.GetLineNum();
    if (depth > deepest) result.refuse("stands in more than " + std::to_string(deepest) + " others");
    if (++count_ > most_elements)
      result.refuse("is one of more than " + std::to_string(most_elements) + " elements");
    for (const tinyxml2::XMLAttribute* one = from.FirstAttribute(); one != nullptr; one = one->Next())
      result.attributes.emplace_back(one->Name(), one->Value());
    if (const char* const text = from.GetText(); text != nullptr) result.text = without_space(text);
    for (const auto* child = from.FirstChildElement(); child != nullptr; child = child->NextSiblingElement())
      result.children.push_back(element(*child, depth + 1));
    return result;
  }

 private:
  const std::string& file_;
  std::size_t count_ = 0;
};

std::optional<std::vector<double>> numbers_of(std::string_view text, std::size_t most) {
  std::vector<double> numbers;
  for (text = without_space(text); !text.empty(); text = without_space(text)) {
    if (text.front() == '+') text.remove_prefix(1);
    double number = 0.0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error == std::errc::result_out_of_range) {
      number = 0.0;  // as the 1e-320 of CAD programs; what is too large is refused by its digits
      if (text.substr(0, static_cast<std::size_t>(end - text.data())).find("e-") == std::string_view::npos)
        return std::nullopt;
    } else if (error != std::errc()) {
      return std::nullopt;
    }
    text.remove_prefix(static_cast<std::size_t>(end - text.data()));
    const bool ends =
        text.empty() || std::string_view(" \t\r\n").find(text.front()) != std::string_view::npos;
    if (!ends || !(std::abs(number) <= largest_number) || numbers.size() == most) return std::nullopt;
    numbers.push_back(number);
  }
  return numbers;
}

std::string counted(std::size_t count) {
  return count == 1 ? "a finite number" : std::to_string(count) + " finite numbers";
}

}  // namespace

const XmlElement* XmlElement::child(std::string_view child_name) const {
  for (const XmlElement& one : children) {
    if (one.name == child_name) return &one;
  }
  return nullptr;
}

std::vector<const XmlElement*> XmlElement::all(std::string_view child_name) const {
  std::vector<const XmlElement*> found;
  for (const XmlElement& one : children) {
    if (one.name == child_name) found.push_back(&one);
  }
  return found;
}

std::optional<std::string> XmlElement::attribute(std::string_view attribute_name) const {
  for (const auto& [key, value] : attributes) {
    if (key == attribute_name) return value;
  }
  return std::nullopt;
}

void XmlElement::refuse(const std::string& complaint) const {
  const auto named = attribute("name");
  throw SetupError(file + ":" + std::to_string(line) + ": <" + name +
                   (named ? " name=\"" + *named + "\"" : "") + "> " + complaint);
}

std::string XmlElement::required(std::string_view attribute_name) const {
  const auto value = attribute(attribute_name);
  if (!value || value->empty()) refuse("has no attribute '" + std::string(attribute_name) + "'");
  return *value;
}

std::vector<double> XmlElement::numbers(std::string_view attribute_name, std::size_t most) const {
  const auto value = attribute(attribute_name);
  if (!value) return {};
  const auto found = numbers_of(*value, most);
  if (!found) {
    refuse("has " + std::string(attribute_name) + "=\"" + *value + "\"; it must be " +
           (most == 1 ? counted(1) : "at most " + counted(most)));
  }
  return *found;
}

double XmlElement::number(std::string_view attribute_name, double otherwise) const {
  const std::vector<double> found = numbers(attribute_name, 1);
  if (found.empty() && attribute(attribute_name))
    refuse("has an empty attribute '" + std::string(attribute_name) + "'; it must be " + counted(1));
  return found.empty() ? otherwise : found.front();
}

Eigen::Vector3d XmlElement::vector(std::string_view attribute_name, const Eigen::Vector3d& otherwise) const {
  if (!attribute(attribute_name)) return otherwise;
  const std::vector<double> found = numbers(attribute_name, 3);
  if (found.size() != 3) {
    refuse("has " + std::string(attribute_name) + "=\"" + *attribute(attribute_name) + "\"; it must be " +
           counted(3));
  }
  return {found[0], found[1], found[2]};
}

std::vector<double> XmlElement::text_numbers(std::size_t most) const {
  const auto found = numbers_of(text, most);
  if (!found) refuse("is '" + text.substr(0, 80) + "'; it must be at most " + counted(most));
  return *found;
}

double XmlElement::number_in(std::string_view child_name, double otherwise) const {
  const XmlElement* const one = child(child_name);
  if (one == nullptr) return otherwise;
  const std::vector<double> found = one->text_numbers(1);
  if (found.empty()) one->refuse("is empty; it must be " + counted(1));
  return found.front();
}

Eigen::Vector3d XmlElement::vector_in(std::string_view child_name, const Eigen::Vector3d& otherwise) const {
  const XmlElement* const one = child(child_name);
  if (one == nullptr) return otherwise;
  const std::vector<double> found = one->text_numbers(3);
  if (found.size() != 3) one->refuse("is '" + one->text.substr(0, 80) + "'; it must be " + counted(3));
  return {found[0], found[1], found[2]};
}

XmlElement parse_xml(std::string_view text, const std::string& file) {
  if (text.size() > largest_document)
    throw SetupError(file + ": is larger than 16 MB; descriptions of robots are smaller");
  tinyxml2::XMLDocument document;
  if (document.Parse(text.data(), text.size()) != tinyxml2::XML_SUCCESS) {
    throw SetupError(file + ":" + std::to_string(document.ErrorLineNum()) +
                     ": is no XML: " + tinyxml2::XMLDocument::ErrorIDToName(document.ErrorID()));
  }
  const tinyxml2::XMLElement* const root = document.RootElement();
  if (root == nullptr) throw SetupError(file + ": holds no element; it must be URDF, SDF or MJCF");
  return XmlReader(file).element(*root, 0);
}

}  // namespace flinch
