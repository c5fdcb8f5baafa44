#include "systems/config/yaml_text.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "systems/config/config_file.h"
#include "systems/config/config_node.h"
#include "systems/foundation/setup_error.h"

namespace flinch {
namespace {

using ::testing::HasSubstr;

std::shared_ptr<const ConfigNode> parsed(std::string_view text) { return parse_yaml(text, "a.yaml"); }

/// Lines aside, which differ.
bool same(const ConfigNode& a, const ConfigNode& b) {
  if (a.kind != b.kind || a.scalar != b.scalar || a.items.size() != b.items.size() ||
      a.entries.size() != b.entries.size())
    return false;
  for (std::size_t i = 0; i < a.items.size(); ++i) {
    if (!same(*a.items[i], *b.items[i])) return false;
  }
  for (std::size_t i = 0; i < a.entries.size(); ++i) {
    if (a.entries[i].key != b.entries[i].key || !same(*a.entries[i].value, *b.entries[i].value)) return false;
  }
  return true;
}

std::string changed(std::string_view text, std::string_view path, const std::string& value) {
  return yaml_line(*with_value(*parsed(text), path, scalar_node(value)));
}

std::string complaint(std::string_view text, std::string_view path) {
  try {
    with_value(*parsed(text), path, scalar_node("1"));
  } catch (const SetupError& error) {
    return error.problems().front();
  }
  return "";
}

TEST(YamlText, OfEveryShippedFileParsesToTheSameValues) {
  int files = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(FLINCH_SOURCE_DIR "/apps")) {
    if (entry.path().extension() != ".yaml") continue;
    const auto root = parsed(read_config_file(entry.path()));
    EXPECT_TRUE(same(*parsed(yaml_text(*root)), *root)) << entry.path() << "\n" << yaml_text(*root);
    EXPECT_TRUE(same(*parsed("x: " + yaml_line(*root))->entries.front().value, *root)) << entry.path();
    ++files;
  }
  EXPECT_GE(files, 10);
}

TEST(YamlText, QuotesWhatIsNoPlainWord) {
  for (const char* text :
       {"x: \"a: b, c\"", "x: 'say \"1\"'", "x: \"two\\nlines\\tand \\\\\"", "x: \"\"", "x: ~"}) {
    const auto root = parsed(text);
    EXPECT_TRUE(same(*parsed(yaml_text(*root)), *root)) << yaml_text(*root);
  }
  EXPECT_TRUE(parsed(yaml_text(*parsed("x: '5'")))->entries.front().value->quoted);
  EXPECT_FALSE(parsed(yaml_text(*parsed("x: 5")))->entries.front().value->quoted);
}

TEST(AValuePutIn, ReplacesWhatStandsThere) {
  EXPECT_EQ(changed("a: {b: 1, c: 2}", "a.b", "5"), "{a: {b: 5, c: 2}}");
  EXPECT_EQ(changed("a: [{b: 1}, {b: 2}]", "a[1].b", "5"), "{a: [{b: 1}, {b: 5}]}");
}

TEST(AValuePutIn, MakesTheSectionsThatAreMissing) {
  EXPECT_EQ(changed("a: 1", "b.c.d", "5"), "{a: 1, b: {c: {d: 5}}}");
  EXPECT_EQ(changed("a:", "a.b", "5"), "{a: {b: 5}}");
}

TEST(AValuePutIn, TakesThePlaceOfTheSameQuantityInAnotherUnit) {
  EXPECT_EQ(changed("radius_mm: 40\nmass_kg: 1", "radius_m", "0.05"), "{radius_m: 0.05, mass_kg: 1}");
  EXPECT_EQ(changed("x_mm: 40", "x_m_per_s", "2"), "{x_m_per_s: 2}")
      << "one of x in other units: the reader tells";
}

TEST(AValuePutIn, LeavesTheOriginalAsItWas) {
  const auto root = parsed("a: {b: 1}");
  with_value(*root, "a.b", scalar_node("5"));
  EXPECT_EQ(yaml_line(*root), "{a: {b: 1}}");
}

TEST(AValuePutIn, SaysWhichPartOfThePathFitsNothing) {
  EXPECT_THAT(complaint("a: [{b: 1}]", "a[1].b"), HasSubstr("the list has 1 entries"));
  EXPECT_THAT(complaint("a: 1", "a.b"), HasSubstr("'a.' has no keys"));
  EXPECT_THAT(complaint("a: 1", "a[0]"), HasSubstr("the list has 0 entries"));
  EXPECT_THAT(complaint("a: [1]", "a[x]"), HasSubstr("must be followed by the number"));
  EXPECT_THAT(complaint("a: [1]", "a[0"), HasSubstr("must be followed by the number"));
  EXPECT_THAT(complaint("a: 1", "a..b"), HasSubstr("no path of keys"));
  EXPECT_THAT(complaint("a: {}", "a."), HasSubstr("no path of keys"));
  EXPECT_THAT(complaint("a: 1", ""), HasSubstr("is no key"));
}

TEST(Paths, NameOneValueWhateverItsUnit) {
  EXPECT_TRUE(name_one_value("pylon.radius_mm", "pylon.radius_mm"));
  EXPECT_TRUE(name_one_value("pylon.radius_mm", "pylon.radius_m"));
  EXPECT_TRUE(name_one_value("obstacles[0].radius_mm", "obstacles[0].radius_cm"));
  EXPECT_TRUE(name_one_value("duration_s", "duration_ms"));
  EXPECT_FALSE(name_one_value("pylon.radius_mm", "obstacles[0].radius_mm"));
  EXPECT_FALSE(name_one_value("obstacles[0].radius_mm", "obstacles[1].radius_mm"));
  EXPECT_FALSE(name_one_value("gain[0]", "gain[1]"));
  EXPECT_FALSE(name_one_value("pylon.x_mm", "pylon.y_mm"));
  EXPECT_FALSE(name_one_value("duration_s", "motion.duration_s"));
}

}  // namespace
}  // namespace flinch
