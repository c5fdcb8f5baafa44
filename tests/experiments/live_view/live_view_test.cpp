#include "experiments/live_view/live_view.h"

#include <gmock/gmock.h>

#include <atomic>
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <thread>

#include "experiments/simulated/experiment.h"
#include "experiments/simulated/simulated_scenario.h"
#include "systems/framework/recording.h"
#include "systems/robot/quantity_units.h"
#include "tests/experiments/live_view/loopback_connection.h"
#include "tests/experiments/report/chromium.h"
#include "tests/support/allocations.h"
#include "tests/support/locks.h"
#include "tests/support/temporary_folder.h"

namespace flinch {
namespace {

using nlohmann::json;
using std::chrono::milliseconds;
using test::TemporaryFolder;
using testing::HasSubstr;

const char* const collision = FLINCH_SOURCE_DIR "/apps/scenarios/platform_collision.yaml";

LiveViewSettings at_speed(double speed, milliseconds patience = milliseconds(0)) {
  LiveViewSettings settings;
  settings.speed = speed;
  settings.patience = patience;
  return settings;
}

/// The messages in what a viewer got, without the chunks' lengths between them.
std::vector<json> messages_in(const std::string& stream) {
  std::vector<json> messages;
  const std::string begin = "data: ";
  for (std::size_t at = stream.find(begin); at != std::string::npos; at = stream.find(begin, at + 1)) {
    const std::size_t from = at + begin.size();
    messages.push_back(json::parse(stream.substr(from, stream.find("\n\n", at) - from)));
  }
  return messages;
}

TEST(LiveView, ChangesNothingOfTheRecording) {
  const SimulatedScenario scenario = read_simulated_scenario(collision);
  const TemporaryFolder folder;
  const Recording plain = record_experiment(scenario, folder.path() / "plain.h5");
  LiveView view(scenario, at_speed(2.0, milliseconds(3000)));
  const LiveAddress where(view.address());
  std::thread viewer([&where] {  // who orders this and that
    LoopbackConnection feed(where.port);
    feed.send("GET " + where.root + "feed HTTP/1.1\r\nHost: " + where.host + "\r\n\r\n");
    for (const std::string order : {"pause", "tick", "tick", "speed 5", "go"}) {
      answer(where, "POST " + where.root + "order", where.host,
             "Content-Length: " + std::to_string(order.size()) + "\r\n\r\n" + order);
    }
    feed.read_until("\"ended\"");
  });
  const Recording watched = record_experiment(scenario, folder.path() / "watched.h5", {}, {}, &view);
  view.finish("<p>report</p>");
  viewer.join();
  ASSERT_EQ(watched.samples(), plain.samples());
  ASSERT_EQ(watched.signals.size(), plain.signals.size());
  EXPECT_EQ(watched.time_ns, plain.time_ns);
  EXPECT_EQ(watched.attributes, plain.attributes);
  for (const Signal& signal : plain.signals) {
    std::vector<internal::Number> one(plain.samples() * signal.layout.numbers);
    std::vector<internal::Number> other(one.size());
    plain.read_rows(signal, 0, plain.samples(), one.data());
    watched.read_rows(watched.signal(signal.path), 0, plain.samples(), other.data());
    EXPECT_EQ(std::memcmp(one.data(), other.data(), one.size() * sizeof one[0]), 0) << signal.path;
  }
}

TEST(LiveView, CostsTheTickNoAllocationAndNoLock) {
  const SimulatedScenario scenario = read_simulated_scenario(collision);
  const Experiment experiment = build_experiment(scenario);
  Context context = experiment.diagram->make_context();
  experiment.diagram->evaluate(context);
  LiveView view(scenario, at_speed(1.0));
  Recorder& recorder = view.begin(*experiment.diagram, quantity_units(*scenario.robot.robot), {});
  const test::AllocationCounter allocations;
  const std::int64_t locks = test::locks();
  for (std::size_t i = 0; i < 4 * LiveView::ring; ++i) recorder.record(context);  // more than has room
  EXPECT_EQ(allocations.count(), 0);
  EXPECT_EQ(test::locks() - locks, 0);
  EXPECT_GT(recorder.dropped(), 0);
}

TEST(LiveView, ShowsEveryViewerWhatIsRecorded) {
  const SimulatedScenario scenario = read_simulated_scenario(collision);
  const TemporaryFolder folder;
  LiveView view(scenario, at_speed(0.25, milliseconds(3000)));  // a busy machine thins no message
  const LiveAddress where(view.address());
  const auto ask = [&where](LoopbackConnection& viewer) {
    viewer.send("GET " + where.root + "feed HTTP/1.1\r\nHost: " + where.host + "\r\n\r\n");
  };
  LoopbackConnection one(where.port), other(where.port), stalled(where.port, 4096);
  ask(stalled);
  std::string read[2];
  std::thread reads_one([&] { ask(one), read[0] = one.read_all(); });
  std::thread reads_other([&] { ask(other), read[1] = other.read_all(); });
  const Recording recording = record_experiment(scenario, folder.path() / "run.h5", {}, {}, &view);
  view.finish("<p>report</p>");
  reads_one.join();
  reads_other.join();
  const std::vector<double> force = recording.column("wrench", "wrench_in_base", 0);
  for (const std::string& stream : read) {
    std::size_t samples = 0, compared = 0;
    double last = -1.0;
    for (const json& message : messages_in(stream)) {
      if (!message.contains("times")) continue;
      const std::vector<double> times = message["times"];
      const bool is_thinned = times.back() - times.front() > 1e-3 * (static_cast<double>(times.size()) - 0.5);
      for (std::size_t k = 0; k < times.size(); ++k, ++samples) {
        EXPECT_GT(times[k], last) << "in order";
        last = times[k];
        const json& shown = message["columns"]["estimated_force_x"][k];
        const auto tick = static_cast<std::size_t>(std::llround(times[k] * 1e3));
        if (!is_thinned && !shown.is_null()) {
          EXPECT_NEAR(shown.get<double>(), force[tick], 1e-5 * (1.0 + std::abs(force[tick])));
          ++compared;
        }
      }
    }
    EXPECT_GT(samples, 200U);
    EXPECT_GT(compared, 100U);
    EXPECT_NEAR(last, 1e-9 * static_cast<double>(recording.time_ns.back()), 0.05);
    EXPECT_THAT(stream, HasSubstr("\"ended\": true"));
  }
}

TEST(LiveView, WaitsForNobodyLongerThanItMay) {
  const SimulatedScenario scenario = read_simulated_scenario(collision);
  const TemporaryFolder folder;
  const auto begin = std::chrono::steady_clock::now();
  LiveView view(scenario, at_speed(100.0, milliseconds(200)));
  record_experiment(scenario, folder.path() / "run.h5", {}, {}, &view);
  view.finish("");
  EXPECT_GE(std::chrono::steady_clock::now() - begin, milliseconds(200));
  EXPECT_LT(std::chrono::steady_clock::now() - begin, milliseconds(20'000));
}

TEST(LiveView, EndsWaitingWhenSomebodyInterrupts) {
  const SimulatedScenario scenario = read_simulated_scenario(collision);
  const TemporaryFolder folder;
  LiveViewSettings settings = at_speed(100.0, milliseconds(3'600'000));
  settings.interrupted = [] { return true; };
  LiveView view(scenario, settings);
  record_experiment(scenario, folder.path() / "run.h5", {}, {}, &view);
  view.finish("");
}

TEST(LiveView, MovesRobotAndChartsInABrowser) {
  const SimulatedScenario scenario = read_simulated_scenario(collision);
  const TemporaryFolder folder;
  std::atomic<bool> interrupted = false;
  LiveViewSettings settings = at_speed(0.004, milliseconds(300'000));
  settings.interrupted = [&interrupted] { return interrupted.load(); };
  LiveView view(scenario, settings);
  std::thread run([&] {
    record_experiment(scenario, folder.path() / "run.h5", {}, {}, &view);
    view.finish("<link rel=\"icon\" href=\"data:,\"><title>the report</title>");
  });
  expect_works_in_chromium(view.address(), "live_view/live_in_browser.py");
  interrupted = true;
  const LiveAddress where(view.address());
  try {
    for (const std::string order : {"speed 100", "go"}) {
      answer(where, "POST " + where.root + "order", where.host,
             "Content-Length: " + std::to_string(order.size()) + "\r\n\r\n" + order);
    }
  } catch (const std::runtime_error&) {  // it has ended
  }
  run.join();
}

}  // namespace
}  // namespace flinch
