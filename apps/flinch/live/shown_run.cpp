#include "apps/flinch/live/shown_run.h"

#include <chrono>
#include <csignal>
#include <string>
#include <utility>

#include "apps/flinch/printing.h"
#include "experiments/live_view/live_view.h"
#include "systems/foundation/bytes_of_file.h"

namespace flinch {
namespace {

volatile std::sig_atomic_t interrupted = 0;

LiveViewSettings settings_of(const LiveOptions& options, ShownPace pace) {
  LiveViewSettings settings;
  if (options.port != "true") settings.server.port = std::stoi(options.port);
  settings.speed = pace == ShownPace::ordered ? std::optional(options.speed) : std::nullopt;
  settings.patience = std::chrono::milliseconds(static_cast<std::int64_t>(1e3 * options.wait));
  settings.interrupted = [] { return interrupted != 0; };
  return settings;
}

class RunInBrowser : public ShownRun {
 public:
  RunInBrowser(const Scenario& scenario, LiveViewSettings settings) : view_(scenario, std::move(settings)) {
    print_message("live: {}\n", view_.address());
    flush_messages();
  }

  Spectator& spectator() override { return view_; }

  void finish(const std::filesystem::path& report) override {
    std::signal(SIGINT, [](int) { interrupted = 1; });
    view_.finish(bytes_of_file(report));
    std::signal(SIGINT, SIG_DFL);
  }
  void finish() override { view_.finish(); }

 private:
  LiveView view_;
};

}  // namespace

std::unique_ptr<ShownRun> show_live(const RunOptions& options, const Scenario& scenario, ShownPace pace,
                                    OrderFromPage operator_order) {
  const LiveOptions& live = options.live;
  if (!live.asked()) return nullptr;
  LiveViewSettings settings = settings_of(live, pace);
  settings.operator_order = std::move(operator_order);
  auto shown = std::make_unique<RunInBrowser>(scenario, std::move(settings));
  const bool silent = options.common.quiet || options.common.json;
  if (pace == ShownPace::ordered && live.wait > 0.0 && !silent) {
    print_message("the simulation begins when that is open in a browser, or after {:g} s\n", live.wait);
    flush_messages();
  }
  return shown;
}

std::unique_ptr<ShownRun> show_rig_live(const LiveOptions& live, const Scenario& scenario) {
  if (!live.asked()) return nullptr;
  return std::make_unique<RunInBrowser>(scenario, settings_of(live, ShownPace::own));
}

}  // namespace flinch
