#pragma once

#include <atomic>
#include <chrono>
#include <cstddef>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <thread>

#include "experiments/live/spectator.h"
#include "experiments/live_view/live_feed.h"
#include "experiments/live_view/live_server.h"
#include "experiments/live_view/simulation_pace.h"
#include "systems/framework/recorder.h"
#include "systems/framework/recording.h"

namespace flinch {

struct Scenario;

struct LiveViewSettings {
  LiveServerSettings server = {};
  /// At which a simulation begins; see SimulationPace. None: the run goes as fast as it does, and takes no
  /// orders.
  std::optional<double> speed = 1.0;
  /// Follows orders to the robot, where there is no speed; none: the page has no buttons for an operator.
  /// Called by threads of the server.
  LiveServer::Order operator_order{};
  /// How long a simulation waits for the first viewer, and how long the report stays for those who have not
  /// fetched it.
  std::chrono::milliseconds patience{60'000};
  std::function<bool()> interrupted = [] { return false; };  ///< Somebody wants no more waiting.
};

/// Shows a run in browsers while it goes on: the scene and the charts of its report.
///
/// The run hands each tick to a recorder; a thread takes the samples from there about thirty times a second,
/// makes messages of them, and gives them to a LiveServer. Where it does not keep up, samples are not shown;
/// the run never waits for it.
class LiveView : public Spectator {
 public:
  static constexpr std::size_t ring = 2048;  ///< samples that may wait for the thread: 2 s at 1 kHz
  static constexpr std::chrono::milliseconds frame{33};
  static constexpr std::size_t most_samples = 40;  ///< of a message; more are thinned as in a report

  /// `scenario` must outlive this. Throws SetupError where the port cannot be had.
  explicit LiveView(const Scenario& scenario, LiveViewSettings settings = {});
  ~LiveView() override;

  const std::string& address() const { return server_.address(); }
  const LiveServer& server() const { return server_; }

  Recorder& begin(const Diagram& diagram, const UnitTable& units,
                  const std::map<std::string, std::string>& attributes) override;
  /// The first waits for a viewer, too.
  void before_tick(Time next) override;

  /// Shows what is left of the run, makes its page that of the `report`, and returns when every viewer has
  /// it.
  void finish(std::string report);
  /// The same without a report: the pages stay as they are.
  void finish();

 private:
  void run();
  void show_samples();
  /// Whether the time of the run has gone back; then what was before it is left out.
  bool begins_anew();
  void show_pace();
  void show_page(const Recording& nothing);
  void stop_thread();
  void wait_until(const std::function<bool()>& done) const;

  const Scenario& scenario_;
  LiveViewSettings settings_;
  SimulationPace pace_;
  LiveFeed feed_;
  LiveServer server_;
  std::optional<Recorder> recorder_;
  Recording latest_;  ///< of the thread: what it has just taken
  std::optional<PaceState> pace_shown_;
  std::int64_t dropped_shown_ = 0;
  std::int64_t last_shown_ = 0;  ///< time of the last sample [ns]
  bool has_waited_ = false;
  std::atomic<bool> stops_ = false;
  std::thread thread_;  ///< the last: it sees all others
};

}  // namespace flinch
