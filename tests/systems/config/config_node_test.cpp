#include "systems/config/config_node.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "tests/systems/config/problems_of.h"

namespace flinch {
namespace {

using test::Problems;
using test::problems_of;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::StartsWith;
using Kind = ConfigNode::Kind;

Problems problems_of_yaml(const std::string& text) {
  return problems_of([&] { parse_yaml(text, "a.yaml"); });
}

TEST(ParsingYaml, GivesValuesInOrderWithTheirLines) {
  const auto root = parse_yaml("# a robot\nname: Bench\n\nlegs:\n  - 1\n  - two\n", "a.yaml");
  ASSERT_EQ(root->kind, Kind::mapping);
  ASSERT_EQ(root->entries.size(), 2U);
  EXPECT_EQ(root->entries[0].key, "name");
  EXPECT_EQ(root->entries[0].line, 2);
  EXPECT_EQ(root->entries[0].value->scalar, "Bench");
  const ConfigNode& legs = *root->entries[1].value;
  ASSERT_EQ(legs.kind, Kind::list);
  EXPECT_EQ(legs.items[0]->line, 5);
  EXPECT_EQ(legs.items[1]->scalar, "two");
}

TEST(ParsingYaml, TellsTextInQuotesFromPlainWords) {
  const auto root = parse_yaml("a: 1\nb: \"1\"\nc: '1'\nd: ~\n", "a.yaml");
  EXPECT_FALSE(root->entries[0].value->quoted);
  EXPECT_TRUE(root->entries[1].value->quoted);
  EXPECT_TRUE(root->entries[2].value->quoted);
  EXPECT_EQ(root->entries[3].value->kind, Kind::empty);
}

TEST(ParsingYaml, KeepsAKeyThatComesTwice) {
  EXPECT_EQ(parse_yaml("a: 1\na: 2\n", "a.yaml")->entries.size(), 2U);
}

TEST(ParsingYaml, FollowsAnAliasToItsAnchor) {
  const auto root = parse_yaml("a: &x {b: 3}\nc: *x\n", "a.yaml");
  EXPECT_EQ(root->entries[0].value, root->entries[1].value);
}

TEST(ParsingYaml, RefusesMappingsWithoutEnd) {
  std::string text;
  for (int i = 0; i <= 1000; ++i) text += "key" + std::to_string(i) + ": 1\n";
  EXPECT_THAT(problems_of_yaml(text), ElementsAre(HasSubstr("more than 1000 keys in one mapping")));
}

TEST(ParsingYaml, CountsAliasesAsWhatTheyStandFor) {
  std::string text = "a0: &a0 [1, 1, 1, 1, 1, 1, 1, 1, 1, 1]\n";
  for (int i = 1; i < 40; ++i) {
    const std::string last = "*a" + std::to_string(i - 1), name = "a" + std::to_string(i);
    text += name + ": &" + name + " [" + last + ", " + last + ", " + last + "]\n";
  }
  EXPECT_THAT(problems_of_yaml(text), ElementsAre(HasSubstr("too many values")));
}

TEST(ParsingYaml, GivesAnEmptyNodeForNoDocument) {
  EXPECT_EQ(parse_yaml("", "a.yaml")->kind, Kind::empty);
  EXPECT_EQ(parse_yaml("# only a remark\n", "a.yaml")->kind, Kind::empty);
}

TEST(ParsingYaml, ReadsWindowsLineEndsAndByteOrderMarks) {
  const auto root = parse_yaml(
      "\xef\xbb\xbf"
      "a: 1\r\nb: 2\r\n",
      "a.yaml");
  ASSERT_EQ(root->entries.size(), 2U);
  EXPECT_EQ(root->entries[0].key, "a");
  EXPECT_EQ(root->entries[1].value->scalar, "2");
}

TEST(MalformedYaml, IsToldWithLineAndColumn) {
  EXPECT_THAT(problems_of_yaml("a: 1\nb: c: d\n"),
              ElementsAre(StartsWith("a.yaml:2:5: is not valid YAML: illegal map value; check indentation")));
  EXPECT_THAT(problems_of_yaml("a: 1\nb: [1, 2\nc: 3\n"),
              ElementsAre(StartsWith("a.yaml:3:2: is not valid YAML")));
  EXPECT_THAT(problems_of_yaml("a:\n\tb: 2\n"), ElementsAre(HasSubstr("a.yaml:2:")));
}

TEST(MalformedYaml, IncludesAliasesThatLeadNowhereOrIntoThemselves) {
  EXPECT_THAT(problems_of_yaml("a: *x\n"), ElementsAre(HasSubstr("a.yaml:1:4: ")));
  EXPECT_THAT(problems_of_yaml("a: &x\n  b: *x\n"), ElementsAre(HasSubstr("an alias inside its own anchor")));
}

TEST(MalformedYaml, IncludesNamesThatWouldEndEarly) {
  for (const std::string text : {R"("b\0.yaml")", R"(["b\0"])", R"({"b\0": 1})", R"(["b\x00c"])"}) {
    EXPECT_THAT(
        problems_of_yaml("a: 1\nfile: " + text + "\n"),
        ElementsAre(StartsWith("a.yaml:2: 'b' goes on with a character 0, at which names end; leave it out")))
        << text;
  }
}

TEST(MalformedYaml, IncludesWhatNoSettingsNeed) {
  EXPECT_THAT(problems_of_yaml("a: 1\n---\nb: 2\n"),
              ElementsAre(HasSubstr("a.yaml:3: a second YAML document begins")));
  EXPECT_THAT(problems_of_yaml("[a, b]: 1\n"), ElementsAre(HasSubstr("a key that is no word")));
  std::string deep = "a: ";
  for (int i = 0; i < 2000; ++i) deep += "{a: ";
  EXPECT_THAT(problems_of_yaml(deep), ElementsAre(HasSubstr("nested too deeply")));
}

// Whatever a file holds, it is read or refused; nothing else happens.
TEST(ParsingYaml, SurvivesDamagedFiles) {
  const std::string whole = "kind: planar_3rrr\nlegs:\n  - {a_m: 0.5, b: &x [1, 2]}\n  - 'c': *x\n# end\n";
  std::mt19937 random(1);
  int refused = 0;
  for (int trial = 0; trial < 3000; ++trial) {
    std::string damaged = whole;
    for (int i = 0; i < 3; ++i) damaged[random() % damaged.size()] = static_cast<char>(random() % 256);
    damaged.resize(random() % (damaged.size() + 1));
    refused += problems_of_yaml(damaged).empty() ? 0 : 1;
  }
  EXPECT_GT(refused, 500);
  EXPECT_LT(refused, 2900);
}

}  // namespace
}  // namespace flinch
