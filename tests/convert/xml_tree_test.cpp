// Hostile documents are refused with their line.
#include "convert/xml_tree.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "convert/conversion.h"
#include "systems/foundation/setup_error.h"
#include "tests/convert/converted_models.h"

namespace flinch {
namespace {

using ::testing::HasSubstr;

std::string complaint(const std::string& text) {
  try {
    read_model(text, "model.urdf");
  } catch (const SetupError& error) {
    return error.what();
  }
  return "";
}

TEST(XmlTree, HasTheElementsOfADocument) {
  const XmlElement root = parse_xml("<a x='1'>\n <b y='1 2 3'/> t <b/></a>", "f.xml");
  EXPECT_EQ(root.all("b").size(), 2U);
  EXPECT_EQ(root.child("b")->line, 2);
  EXPECT_EQ(root.child("b")->vector("y", Eigen::Vector3d::Zero()), Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(root.number("x", 0.0), 1.0);
  EXPECT_EQ(root.number("z", 7.0), 7.0);
}

TEST(XmlTree, RefusesWhatIsNoXml) {
  for (const char* text : {"", "kind: legs", "<robot>", "<robot></sdf>", "<robot", "\x01\x02", "<!-- -->"})
    EXPECT_THAT(complaint(text), HasSubstr("model.urdf")) << text;
  EXPECT_THAT(complaint("<html/>"), HasSubstr("is no description of a robot"));
}

TEST(XmlTree, DoesNotExpandEntities) {
  std::string bomb = "<!DOCTYPE lolz [<!ENTITY a \"lol\">";
  for (char c = 'b'; c < 'm'; ++c) {
    bomb += std::string("<!ENTITY ") + c + " \"";
    for (int i = 0; i < 10; ++i) bomb += std::string("&") + static_cast<char>(c - 1) + ";";
    bomb += "\">";
  }
  EXPECT_NE(complaint(bomb + "]><robot name=\"&l;\"><link name=\"&l;\"/></robot>"), "nothing");
}

TEST(XmlTree, RefusesElementsInOneAnotherWithoutEnd) {
  std::string deep;
  for (int i = 0; i < 100'000; ++i) deep += "<a>";
  EXPECT_THAT(complaint(deep), HasSubstr("model.urdf"));
  std::string within;
  for (int i = 0; i < 80; ++i) within += "<a>";
  for (int i = 0; i < 80; ++i) within += "</a>";
  EXPECT_THAT(complaint(within), HasSubstr("stands in more than 50 others"));
}

TEST(XmlTree, RefusesWhatIsTooLarge) {
  EXPECT_THAT(complaint("<robot>" + std::string(17 << 20, ' ') + "</robot>"), HasSubstr("larger than 16 MB"));
  std::string many = "<robot>";
  for (int i = 0; i < 100'001; ++i) many += "<a/>";
  EXPECT_THAT(complaint(many + "</robot>"), HasSubstr("one of more than 100000 elements"));
}

TEST(XmlTree, RefusesNumbersThatAreNone) {
  for (const char* bad : {"nan", "inf", "1e300", "1 2", "1 2 3 4", "x", "1,2,3", "0x10 0 0", "1e999 0 0"}) {
    const std::string text =
        std::string(
            "<robot name='r'><link name='a'/><link name='b'/>\n<joint name='j' type='fixed'>"
            "<parent link='a'/><child link='b'/><origin xyz='") +
        bad + "'/></joint></robot>";
    EXPECT_THAT(complaint(text), HasSubstr("model.urdf:2: <origin>")) << bad;
  }
}

TEST(XmlTree, TakesTheTinyNumbersOfCadPrograms) {
  const XmlElement root = parse_xml("<a x='2.4e-320 -1.0e-400 +1'/>", "f.xml");
  EXPECT_LT((root.vector("x", Eigen::Vector3d::Ones()) - Eigen::Vector3d(0, 0, 1)).norm(), 1e-300);
}

}  // namespace
}  // namespace flinch
