#include "systems/config/parsed.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <string_view>
#include <system_error>

namespace flinch {
namespace {

/// Sizes in SI whose squares and products stay finite and above zero, however many are taken.
constexpr Range computable = between(least_computable, 1e24);

// Reads all of `text` as a number; std::errc{} if that is what it is.
template <class Number>
std::errc read_all(std::string_view text, Number& value) {
  if (text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1);
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc{}) return error;
  return stop == end ? std::errc{} : std::errc::invalid_argument;
}

bool is_plain_scalar(const ConfigNode& node) { return node.kind == ConfigNode::Kind::scalar && !node.quoted; }

bool is_not_finite(std::string_view text) {
  constexpr std::array<std::string_view, 9> spellings = {".nan", ".NaN", ".NAN", ".inf", ".Inf",
                                                         ".INF", "nan",  "NaN",  "inf"};
  if (text.starts_with('+') || text.starts_with('-')) text.remove_prefix(1);
  return std::find(spellings.begin(), spellings.end(), text) != spellings.end();
}

// The number as it stands in the file; the complaint says what kind of number is asked for.
Parsed<double> parse_finite(const ConfigNode& node) {
  Parsed<double> parsed;
  const std::string found = description(node);
  if (!is_plain_scalar(node))
    return {0.0, found + "; it must be a number" + (node.quoted ? ", not in quotes" : "")};
  if (is_not_finite(node.scalar)) return {0.0, found + "; it must be a finite number"};
  const std::errc error = read_all(node.scalar, parsed.value);
  if (error == std::errc::result_out_of_range) {
    parsed.complaint = found + "; it must be 0 or of a magnitude between 1e-307 and 1e308";
  } else if (error != std::errc{}) {
    parsed.complaint = found + "; it must be a number";
    if (node.scalar.find(',') != std::string::npos) parsed.complaint += ", with a decimal point";
  }
  return parsed;
}

}  // namespace

std::string description(const ConfigNode& node) {
  switch (node.kind) {
    case ConfigNode::Kind::empty:
      return "is empty";
    case ConfigNode::Kind::list:
      return "is a list";
    case ConfigNode::Kind::mapping:
      return "is a mapping";
    case ConfigNode::Kind::scalar:
      break;
  }
  constexpr std::size_t longest = 60;
  std::string text = node.scalar.substr(0, longest);
  if (node.scalar.size() > longest) text += "...";
  std::replace_if(
      text.begin(), text.end(), [](char c) { return static_cast<unsigned char>(c) < ' '; }, ' ');
  double number = 0.0;
  if (node.quoted) return "is the text \"" + text + "\"";
  if (read_all(text, number) == std::errc{} || is_not_finite(text)) return "is " + text;
  return "is '" + text + "'";
}

Parsed<double> parse_number(const ConfigNode& node, const KeyUnit& unit, const Range& range) {
  Parsed<double> parsed = parse_finite(node);
  if (!parsed.complaint.empty()) return parsed;
  parsed.value = unit.to_si(parsed.value);
  const double magnitude = std::abs(parsed.value);
  if (std::isfinite(magnitude) && magnitude != 0.0 && !computable.contains(magnitude)) {
    parsed.complaint = description(node) + "; it must be 0 or of a size between 1e-24 and 1e24 in SI";
    return parsed;
  }
  if (!range.contains(parsed.value)) {
    parsed.complaint = description(node) + "; it must " + range.requirement(unit);
  }
  return parsed;
}

Parsed<int> parse_integer(const ConfigNode& node, int least, int most) {
  Parsed<int> parsed;
  const std::errc error =
      is_plain_scalar(node) ? read_all(node.scalar, parsed.value) : std::errc::invalid_argument;
  if (error == std::errc::invalid_argument) {
    parsed.complaint = description(node) + "; it must be a whole number";
  } else if (error != std::errc{} || parsed.value < least || parsed.value > most) {
    parsed.complaint =
        description(node) + "; it must lie between " + std::to_string(least) + " and " + std::to_string(most);
  }
  return parsed;
}

Parsed<std::uint64_t> parse_seed(const ConfigNode& node) {
  Parsed<std::uint64_t> parsed;
  if (!is_plain_scalar(node) || read_all(node.scalar, parsed.value) != std::errc{}) {
    parsed.complaint = description(node) + "; it must be a whole number between 0 and 2^64 - 1";
  }
  return parsed;
}

Parsed<bool> parse_flag(const ConfigNode& node) {
  if (is_plain_scalar(node) && node.scalar == "true") return {true, ""};
  if (is_plain_scalar(node) && node.scalar == "false") return {false, ""};
  return {false, description(node) + "; it must be true or false"};
}

Parsed<std::string> parse_text(const ConfigNode& node) {
  if (node.kind != ConfigNode::Kind::scalar) return {"", description(node) + "; it must be text"};
  if (node.scalar.empty()) return {"", "is empty; it must be text"};
  return {node.scalar, ""};
}

std::string exact_text(double value) {
  std::array<char, 32> buffer{};
  const auto [end, error] = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
  return {buffer.data(), end};
}

}  // namespace flinch
