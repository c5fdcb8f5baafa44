#include "apps/flinch/live/shown_run.h"

#include <chrono>
#include <csignal>
#include <fstream>
#include <iterator>
#include <string>
#include <utility>

#include "apps/flinch/printing.h"
#include "experiments/live_view/live_view.h"

namespace flinch {
namespace {

volatile std::sig_atomic_t interrupted = 0;

std::string text_of(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

LiveViewSettings settings_of(const RunOptions& options, ShownPace pace, OrderFromPage operator_order) {
  LiveViewSettings settings;
  settings.operator_order = std::move(operator_order);
  if (options.live.port != "true") settings.server.port = std::stoi(options.live.port);
  settings.speed = pace == ShownPace::ordered ? std::optional(options.live.speed) : std::nullopt;
  settings.patience = std::chrono::milliseconds(static_cast<std::int64_t>(1e3 * options.live.wait));
  settings.interrupted = [] { return interrupted != 0; };
  return settings;
}

class RunInBrowser : public ShownRun {
 public:
  RunInBrowser(const RunOptions& options, const Scenario& scenario, ShownPace pace,
               OrderFromPage operator_order)
      : view_(scenario, settings_of(options, pace, std::move(operator_order))) {
    print_message("live: {}\n", view_.address());
    if (pace == ShownPace::ordered && options.live.wait > 0.0 && !options.common.quiet &&
        !options.common.json)
      print_message("the simulation begins when that is open in a browser, or after {:g} s\n",
                    options.live.wait);
    flush_messages();
  }

  Spectator& spectator() override { return view_; }

  void finish(const std::filesystem::path& report) override {
    std::signal(SIGINT, [](int) { interrupted = 1; });
    view_.finish(text_of(report));
    std::signal(SIGINT, SIG_DFL);
  }

 private:
  LiveView view_;
};

}  // namespace

std::unique_ptr<ShownRun> show_live(const RunOptions& options, const Scenario& scenario, ShownPace pace,
                                    OrderFromPage operator_order) {
  if (!options.live.asked()) return nullptr;
  return std::make_unique<RunInBrowser>(options, scenario, pace, std::move(operator_order));
}

}  // namespace flinch
