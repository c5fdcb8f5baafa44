#include "systems/config/config_reader.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <chrono>
#include <numbers>
#include <optional>

#include "tests/support/problems_of.h"
#include "tests/support/temporary_folder.h"
#include "tests/systems/config/problems_of.h"

namespace flinch {
namespace {

using ::testing::ElementsAre;
using namespace std::chrono_literals;
using test::problems_of;
using test::TemporaryFolder;

ConfigReader reader_of(const std::string& text) { return ConfigReader::parse(text, "a.yaml"); }

double read_number(const std::string& text, const Unit& unit, double value = -1.0) {
  ConfigReader reader = reader_of(text);
  reader.number("x", unit, value);
  reader.finish();
  return value;
}

TEST(ReadingNumbers, ConvertsToSi) {
  EXPECT_EQ(read_number("x_kg: 2.272", unit::kg), 2.272);
  EXPECT_EQ(read_number("x_mm: 581.52", unit::m), 0.58152);
  EXPECT_EQ(read_number("x_deg: 90", unit::rad), std::numbers::pi / 2.0);
  EXPECT_EQ(read_number("x_N_per_mm: 6", unit::N_per_m), 6000.0);
  EXPECT_EQ(read_number("x: 0.5", unit::none), 0.5);
}

TEST(ReadingNumbers, TakesAllPlainSpellings) {
  EXPECT_EQ(read_number("x: 1e-3", unit::none), 1e-3);
  EXPECT_EQ(read_number("x: +2", unit::none), 2.0);
  EXPECT_EQ(read_number("x: -.5", unit::none), -0.5);
  EXPECT_EQ(read_number("x: 5.", unit::none), 5.0);
}

TEST(ReadingNumbers, GivesTheDoubleNearestToTheText) {
  EXPECT_EQ(read_number("x: 0.0016517787610619466", unit::none), 0.0031 * (6.021 / 11.3));
}

TEST(ReadingNumbers, LeavesTheDefaultWhereTheFileIsSilent) {
  EXPECT_EQ(read_number("{}", unit::kg, 7.0), 7.0);
}

TEST(ReadingNumbers, KnowsQuantitiesThatMayHaveNoValue) {
  std::optional<double> bound, limit;
  ConfigReader reader = reader_of("bound_mm: 2");
  reader.number("bound", unit::m, bound, positive);
  reader.number("limit", unit::N, limit, positive);
  const std::vector<ReadValue> values = reader.finish();
  EXPECT_EQ(bound, 0.002);
  EXPECT_EQ(limit, std::nullopt);
  EXPECT_EQ(values[1].value, "none");
}

TEST(ReadingLists, FillsExactlyWhatIsThere) {
  std::array<double, 3> gain{};
  std::vector<double> speeds;
  ConfigReader reader = reader_of("gain_per_s: [20, 20, 10]\nspeeds_mm_per_s: [100, 200]\n");
  reader.numbers("gain", unit::per_s, gain, positive);
  reader.numbers("speeds", unit::m_per_s, speeds);
  reader.finish();
  EXPECT_THAT(gain, ElementsAre(20.0, 20.0, 10.0));
  EXPECT_THAT(speeds, ElementsAre(0.1, 0.2));
}

TEST(ReadingDurations, IsExactToTheNanosecond) {
  std::chrono::nanoseconds period = 2ms, delay = 0ns, offset = 5ns;
  ConfigReader reader = reader_of("period_ms: 1\ndelay_us: 3500.001\n");
  reader.duration("period", period, positive);
  reader.duration("delay", delay);
  reader.duration("offset", offset);
  reader.finish();
  EXPECT_EQ(period, 1ms);
  EXPECT_EQ(delay, 3500001ns);
  EXPECT_EQ(offset, 5ns);
}

enum class Shape { round, square, pointed };

TEST(ReadingWords, FillsEveryKindOfSetting) {
  int count = 0;
  std::uint64_t seed = 0;
  bool noise = false;
  std::string name;
  Shape shape = Shape::round;
  ConfigReader reader =
      reader_of("count: 3\nseed: 18446744073709551615\nnoise: true\nname: the bench\nshape: square\n");
  reader.integer("count", count, 1, 5);
  reader.seed("seed", seed);
  reader.flag("noise", noise);
  reader.text("name", name);
  reader.choice("shape", shape, {{"round", Shape::round}, {"square", Shape::square}});
  reader.finish();
  EXPECT_EQ(count, 3);
  EXPECT_EQ(seed, 18446744073709551615U);
  EXPECT_TRUE(noise);
  EXPECT_EQ(name, "the bench");
  EXPECT_EQ(shape, Shape::square);
}

TEST(ReadingWords, FillsListsOfThem) {
  const std::vector<std::string> known = {"fast", "slow", "late"};
  std::vector<std::string> chosen = {"late"};
  ConfigReader reader = ConfigReader::parse("use: [slow, fast]", "own.yaml");
  reader.words("use", chosen, known);
  reader.words("others", chosen, known);  // silent
  EXPECT_EQ(chosen, (std::vector<std::string>{"slow", "fast"}));
  EXPECT_EQ(reader.finish().front().value, "[slow, fast]");
}

TEST(ReadingWords, RefusesListsWithOthersAndRepetitions) {
  const auto problems_of = [](const std::string& text) {
    std::vector<std::string> chosen;
    ConfigReader reader = ConfigReader::parse(text, "own.yaml");
    reader.words("use", chosen, {"fast", "slow"});
    return test::problems_of([&] { reader.finish(); });
  };
  EXPECT_THAT(problems_of("use: [slow, fasst, slow]"),
              ::testing::ElementsAre("own.yaml:1: use[1]: is 'fasst'; did you mean 'fast'?",
                                     "own.yaml:1: use[2]: is 'slow', as an entry before it"));
  EXPECT_THAT(problems_of("use: slow"),
              ::testing::ElementsAre(::testing::HasSubstr("must be a list of words")));
  EXPECT_THAT(problems_of("use: []"),
              ::testing::ElementsAre(::testing::HasSubstr("must be a list of words")));
}

TEST(ReadingWords, KeepsADefaultThatHasNoWord) {
  Shape shape = Shape::pointed;
  ConfigReader reader = reader_of("{}");
  reader.choice("shape", shape, {{"round", Shape::round}, {"square", Shape::square}});
  reader.finish();
  EXPECT_EQ(shape, Shape::pointed);
}

TEST(ReadingFileNames, StartsInTheFolderOfTheFileThatNamesThem) {
  const TemporaryFolder folder;
  const auto robot = folder.write("robot.yaml", "");
  ConfigReader reader = ConfigReader::open(folder.write("scenario.yaml", "robot: ./robot.yaml\n"));
  std::filesystem::path found;
  reader.file("robot", found);
  reader.finish();
  EXPECT_EQ(found, robot);
}

TEST(ReadingFileNames, TellsTheNearestOneWhereTheKeyStands) {
  const TemporaryFolder folder;
  folder.write("robot.yaml", "");
  const auto scenario = folder.write("scenario.yaml", "a: 1\nrobot: robto.yaml\n");
  EXPECT_THAT(problems_of([&] {
                ConfigReader reader = ConfigReader::open(scenario);
                int a = 0;
                std::filesystem::path found;
                reader.integer("a", a);
                reader.file("robot", found);
                reader.finish();
              }),
              ElementsAre(scenario.string() +
                          ":2: robot: is 'robto.yaml': no such file; did you mean 'robot.yaml'?"));
}

TEST(ReadingSections, DescendsIntoMappingsAndListsOfThem) {
  std::vector<double> masses;
  double width = 0.0;
  ConfigReader reader = reader_of("legs: [{mass_kg: 1}, {mass_g: 2}]\ncover: {width_mm: 5}\n");
  for (ConfigReader& leg : reader.sections("legs")) leg.number("mass", unit::kg, masses.emplace_back());
  ConfigReader cover = reader.section("cover");
  cover.number("width", unit::m, width);
  reader.finish();
  EXPECT_THAT(masses, ElementsAre(1.0, 0.002));
  EXPECT_EQ(width, 0.005);
}

TEST(ReadingSections, KeepsAllDefaultsOfAnAbsentOne) {
  double width = 5.0;
  ConfigReader reader = reader_of("{}");
  ConfigReader cover = reader.section("cover");
  cover.required().number("width", unit::m, width);
  EXPECT_TRUE(reader.sections("legs").empty());
  reader.finish();
  EXPECT_EQ(width, 5.0);
}

TEST(ReadingSections, MayHappenInSeveralPlaces) {
  double a = 0.0, b = 0.0;
  ConfigReader reader = reader_of("s: {a: 1, b: 2}");
  reader.section("s").number("a", unit::none, a);
  reader.section("s").number("b", unit::none, b);
  reader.section("s").number("a", unit::none, a);
  EXPECT_EQ(reader.finish().size(), 3U);
  EXPECT_EQ(a + b, 3.0);
}

TEST(ReadingAlternatives, TellsWhichOneIsThere) {
  ConfigReader reader = reader_of("bodies: {a: 1}");
  EXPECT_TRUE(reader.has("bodies"));
  EXPECT_FALSE(reader.has("base_parameters"));
  EXPECT_EQ(reader.one_of({"base_parameters", "bodies"}), "bodies");
  int a = 0;
  reader.section("bodies").integer("a", a);
  reader.finish();
  EXPECT_EQ(a, 1);
}

// ---------------------------------------------------------------- what a run tells about its parameters

auto is_value(const std::string& key, const std::string& value, const std::string& unit, bool from_file) {
  return ::testing::AllOf(::testing::Field(&ReadValue::key, key), ::testing::Field(&ReadValue::value, value),
                          ::testing::Field(&ReadValue::unit, unit),
                          ::testing::Field(&ReadValue::from_file, from_file));
}

TEST(ReadingSections, CanAskWhetherThereIsASectionOrAWord) {
  ConfigReader reader = reader_of("a: {b: 1}\nc: word\nd: [1]\ne:\n");
  EXPECT_TRUE(reader.has_section("a"));
  for (const char* const other : {"b", "c", "d", "e"}) EXPECT_FALSE(reader.has_section(other)) << other;
}

TEST(ReadValues, ListsEverySettingInSiAndWhereItComesFrom) {
  double length = 0.0, mass = 1.5;
  std::array<double, 2> gain = {20.0, 10.0};
  Shape shape = Shape::square;
  bool noise = true;
  std::chrono::nanoseconds period = 1ms;
  ConfigReader reader = reader_of("legs: [{length_mm: 581.52}]\n");
  ConfigReader leg = reader.sections("legs").front();
  leg.number("length", unit::m, length);
  leg.number("mass", unit::kg, mass);
  reader.numbers("gain", unit::per_s, gain);
  reader.choice("shape", shape, {{"round", Shape::round}, {"square", Shape::square}});
  reader.flag("noise", noise);
  reader.duration("period", period);
  std::vector<double> bounds = {3.0}, several = {1.0, 2.0};
  reader.one_or_numbers("bounds", unit::N, bounds, 2);
  reader.one_or_numbers("several", unit::N, several, 2);
  EXPECT_THAT(reader.finish(),
              ElementsAre(is_value("legs[0].length", "0.58152", "m", true),
                          is_value("legs[0].mass", "1.5", "kg", false),
                          is_value("gain", "[20, 10]", "1/s", false), is_value("shape", "square", "", false),
                          is_value("noise", "true", "", false), is_value("period", "0.001", "s", false),
                          is_value("bounds", "3", "N", false), is_value("several", "[1, 2]", "N", false)));
}

TEST(ConfigReader, ReadsOneNumberOrAListOfThem) {
  const auto read = [](const std::string& text, std::optional<std::size_t> count) {
    ConfigReader reader = reader_of("force_kN: " + text + "\n");
    std::vector<double> values{7.0};
    reader.one_or_numbers("force", unit::N, values, count, positive);
    reader.finish();
    return values;
  };
  EXPECT_THAT(read("2", 3), ElementsAre(2000.0));
  EXPECT_THAT(read("[1, 2, 3]", 3), ElementsAre(1000.0, 2000.0, 3000.0));
  EXPECT_THAT(read("[1, 2]", std::nullopt), ElementsAre(1000.0, 2000.0));
  for (const std::string text : {"[1, 2]", "[]", "-1", "[1, 2, 0]", "{}", "many"})
    EXPECT_THROW(read(text, 3), SetupError) << text;
}

}  // namespace
}  // namespace flinch
