// Programs whose standard streams are closed, full or broken, and whose files may not grow.
#include "apps/flinch/program_start.h"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <filesystem>

#include "systems/framework/recording.h"
#include "tests/apps/flinch/program.h"
#include "tests/support/flinch_program.h"
#include "tests/support/workplace.h"

namespace flinch {
namespace {

using ::testing::HasSubstr;
using Words = std::vector<std::string>;

/// Puts what nothing can be written to in the place of a stream.
bool fill(int stream) {
  const int full = ::open("/dev/full", O_WRONLY);
  return full >= 0 && ::dup2(full, stream) == stream && (full == stream || ::close(full) == 0);
}

/// Puts a pipe there that nobody reads.
bool leave(int stream) {
  int ends[2];
  return ::pipe(ends) == 0 && ::close(ends[0]) == 0 && ::dup2(ends[1], stream) == stream &&
         ::close(ends[1]) == 0;
}

using Spoil = bool (*)(int);
bool shut(int stream) { return ::close(stream) == 0; }

class StandardStreams : public ::testing::Test {
 protected:
  void SetUp() override {
    place.replace("scenarios/platform_collision.yaml", "duration_s: 1.2", "duration_s: 0.3");
    place.write("campaigns/short.yaml",
                "scenario: ../scenarios/platform_collision.yaml\nruns: 2\n"
                "draw: [{key: motion.direction_deg, from: 0, to: 360}]\n");
    ASSERT_EQ(test::flinch(run("before")).status, 1);
  }

  Words run(const std::string& out) const {
    return {"run", place.at("scenarios/platform_collision.yaml"), "--out", place.at(out)};
  }
  /// A call of each verb that ends by itself, with the exit status that it has.
  std::vector<std::pair<Words, int>> calls() const {
    const std::string scenario = place.at("scenarios/platform_collision.yaml");
    std::vector<std::pair<Words, int>> all = {
        {run("out"), 1},
        {{"run", place.at("before/run.h5"), "--station", "recorded", "--out", place.at("again")}, 1},
        {{"report", place.at("before/run.h5"), "--out", place.at("page.html")}, 0},
        {{"graph", scenario}, 0},
        {{"check", scenario}, 0},
        {{"campaign", place.at("campaigns/short.yaml"), "--out", place.at("many"), "--fresh"}, 0},
        {{"keys", place.at("keys"), "--force"}, 0},
        {{"--help"}, 0},
        {{"--version"}, 0},
        {{"no_verb"}, 2},
    };
    for (const char* const verb : {"run", "report", "graph", "check", "campaign", "speed-limit", "import",
                                   "convert", "excite", "serve", "link", "keys", "train", "evaluate"}) {
      all.push_back({{verb, "--help"}, 0});
      all.push_back({{verb, place.at("none"), "--nonsense"}, 2});
    }
    return all;
  }

  static std::optional<int> status(const Words& call, const std::function<bool()>& prepare,
                                   std::string* said = nullptr) {
    test::OtherProgram::Start start = test::flinch_program(call);
    start.prepare = prepare;
    test::OtherProgram program(start);
    const std::optional<int> ended = program.wait(100s);
    if (said != nullptr) *said = program.output();
    return ended;
  }

  test::Workplace place;
};

TEST_F(StandardStreams, MayHoldWhatIsRead) {
  const auto check = [](const std::string& text) {
    test::OtherProgram::Start start = test::flinch_program({"check", "-"});
    start.input = test::OtherProgram::Start::Input::pipe;
    test::OtherProgram program(start);
    program.type(text);
    program.end_input();
    EXPECT_TRUE(program.wait(100s).has_value());
    return program.output();
  };
  const auto scenario = [&] { return test::bytes_of(place / "scenarios/platform_collision.yaml"); };
  EXPECT_THAT(check(scenario()), HasSubstr("standard_input:")) << "there is no robot beside this folder";
  place.replace("scenarios/platform_collision.yaml", "../robots/", place.at("robots/"));
  EXPECT_THAT(check(scenario()), HasSubstr("good"));
  EXPECT_THAT(check(""), HasSubstr("is empty"));
}

TEST_F(StandardStreams, ThatTakeNoMessagesChangeNothing) {
  for (const auto& [call, expected] : calls()) {
    for (const Spoil spoil : {&shut, &fill, &leave})
      EXPECT_EQ(status(call, [&] { return spoil(STDERR_FILENO); }), expected) << call.front();
  }
}

TEST_F(StandardStreams, ThatTakeNoResultsAreAnErrorThatIsTold) {
  for (const auto& [call, expected] : calls()) {
    if (expected == 2) continue;
    for (const Spoil spoil : {&shut, &fill, &leave}) {
      std::string said;
      EXPECT_EQ(status(
                    call, [&] { return spoil(STDOUT_FILENO); }, &said),
                2)
          << call.front();
      EXPECT_THAT(said, HasSubstr("error: what was to be printed cannot be written: ")) << call.front();
    }
  }
  EXPECT_EQ(read_recording(place / "out/run.h5").samples(), 300U) << "what was found is kept";
  EXPECT_TRUE(std::filesystem::exists(place / "out/report.html"));
  EXPECT_TRUE(std::filesystem::exists(place / "many/campaign.html"));
}

TEST_F(StandardStreams, ThatAreClosedAreTakenByNoFile) {
  ASSERT_EQ(status(run("out"), [] { return true; }), 1);
  const std::string whole = test::bytes_of(place / "out/run.h5");
  const auto shut_all = [] { return shut(STDIN_FILENO) && shut(STDOUT_FILENO) && shut(STDERR_FILENO); };
  EXPECT_EQ(status(run("out"), shut_all), 2);
  EXPECT_TRUE(test::bytes_of(place / "out/run.h5") == whole);
}

TEST_F(StandardStreams, AreOpenAfterTheStart) {
  test::OtherProgram program([] {
    for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) ::close(stream);
    start_program();
    char letter = 'x';
    const bool good = ::open("/dev/zero", O_RDONLY) > STDERR_FILENO &&
                      ::read(STDIN_FILENO, &letter, 1) == 0 && ::write(STDOUT_FILENO, &letter, 1) < 0 &&
                      ::write(STDERR_FILENO, &letter, 1) == 1;
    ::_exit(good ? 0 : 1);
  });
  EXPECT_EQ(program.wait(10s), 0);
}

// ---------------------------------------------------------------- files that may not grow

TEST_F(StandardStreams, AFileThatMayNotGrowIsAnErrorThatLeavesNothing) {
  const Words made = {"out", "again", "page.html", "many"};
  for (const auto& [call, expected] : calls()) {
    const bool writes =
        std::any_of(call.begin(), call.end(), [](const auto& word) { return word == "--out"; });
    if (!writes) continue;
    for (const rlim_t most : {0U, 3000U, 40'000U}) {
      for (const std::string& name : made) std::filesystem::remove_all(place / name);
      std::string said;
      const auto limited = [most] {
        const rlimit limit{most, most};
        return ::setrlimit(RLIMIT_FSIZE, &limit) == 0;
      };
      EXPECT_EQ(status(call, limited, &said), 2) << call.front() << " " << most << " " << said;
      for (const auto& entry : std::filesystem::recursive_directory_iterator(place / "")) {
        const bool is_half = entry.path().extension() == ".new" || entry.path().extension() == ".dot";
        EXPECT_FALSE(is_half) << entry.path() << " " << most;
        const bool is_empty = entry.is_regular_file() && entry.file_size() == 0;
        EXPECT_FALSE(is_empty && entry.path().extension() == ".part") << entry.path() << " " << most;
      }
    }
  }
}

}  // namespace
}  // namespace flinch
