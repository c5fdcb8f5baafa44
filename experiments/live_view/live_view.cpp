#include "experiments/live_view/live_view.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "experiments/live_view/give_way.h"
#include "experiments/live_view/page/live_page_template.h"
#include "experiments/recorded/recorded_signals.h"
#include "experiments/report/experiment_report.h"
#include "experiments/report/report_json.h"
#include "experiments/report/report_samples.h"
#include "experiments/report/script_data.h"
#include "experiments/scenario/scenario.h"
#include "systems/framework/monotonic_clock.h"

namespace flinch {
namespace {

constexpr std::size_t kept_messages = 600;  // 20 s
constexpr std::size_t kept_bytes = 16'000'000;

/// Of every group of `together` samples the first [s].
std::vector<double> times_of(const Recording& recording, std::size_t together) {
  std::vector<double> times;
  for (std::size_t k = 0; k < recording.samples(); k += together)
    times.push_back(1e-9 * static_cast<double>(recording.time_ns[k]));
  return times;
}

LiveServer::Order orders_for(SimulationPace& pace, const LiveViewSettings& settings) {
  if (!settings.speed) return settings.operator_order;
  return [&pace](std::string_view order) { return pace.follow(order); };
}

/// As members of a JSON object, with a comma behind.
std::string json_members(const PaceState& pace) {
  return fmt::format(R"("speed": {}, "paused": {}, )", pace.speed, pace.paused);
}

}  // namespace

LiveView::LiveView(const Scenario& scenario, LiveViewSettings settings)
    : scenario_(scenario),
      settings_(std::move(settings)),
      pace_(settings_.speed.value_or(1.0)),
      feed_(kept_messages, kept_bytes),
      server_(feed_, orders_for(pace_, settings_), settings_.server) {}

LiveView::~LiveView() {
  stop_thread();
  feed_.close();
}

Recorder& LiveView::begin(const Diagram& diagram, const UnitTable& units,
                          const std::map<std::string, std::string>& attributes) {
  recorder_.emplace(diagram, recorded_paths(diagram), ring, units);
  latest_ = recorder_->description(attributes);
  show_page(latest_);
  thread_ = std::thread([this] { run(); });
  return *recorder_;
}

void LiveView::show_page(const Recording& nothing) {
  Report report = planned_report(scenario_);
  report.kind = "live";
  add_samples(*scenario_.robot.robot, nothing, report, 1);
  server_.show_page(std::string(live_page_template_before_data) + inside_script(report_json(report)) +
                    std::string(live_page_template_after_data));
}

void LiveView::before_tick(Time next) {
  if (!std::exchange(has_waited_, true)) wait_until([this] { return server_.viewers_so_far() > 0; });
  pace_.wait_until(next);
}

void LiveView::wait_until(const std::function<bool()>& done) const {
  const Time end = MonotonicClock::now() + settings_.patience;
  while (!done() && !settings_.interrupted() && MonotonicClock::now() < end)
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
}

void LiveView::run() {
  give_way();
  while (!stops_) {
    std::this_thread::sleep_for(frame);
    show_samples();
    show_pace();
  }
}

void LiveView::show_samples() {
  const auto taken = std::chrono::system_clock::now().time_since_epoch();
  latest_.time_ns.clear();
  for (Signal& signal : latest_.signals) signal.rows.clear();
  for (std::size_t part = 0; part < 2; ++part) {  // the second lies at the beginning of the ring
    const SampleBlock block = recorder_->front();
    latest_.append(block);
    recorder_->pop(block.samples());
  }
  if (latest_.samples() == 0) return;
  if (begins_anew()) feed_.publish(R"({"anew": true})");
  const std::size_t together = (latest_.samples() + most_samples - 1) / most_samples;
  Report report;
  report.obstacles = std::vector<ReportObstacle>(scenario_.obstacles.size());
  add_samples(*scenario_.robot.robot, latest_, report, together);
  const bool is_operated = !settings_.speed && settings_.operator_order;
  feed_.publish(fmt::format(R"({{"taken": {}, {}"times": [{}], {}}})",
                            std::chrono::duration_cast<std::chrono::milliseconds>(taken).count(),
                            is_operated ? R"("operated": true, )" : "",
                            fmt::join(times_of(latest_, together), ", "), samples_json(report)));
}

bool LiveView::begins_anew() {
  std::size_t first = 0;
  std::int64_t before = last_shown_;
  bool anew = false;
  for (std::size_t k = 0; k < latest_.samples(); before = latest_.time_ns[k++]) {
    if (latest_.time_ns[k] >= before) continue;
    anew = true;
    first = k;
  }
  last_shown_ = before;
  const auto forget = [first](auto& values, std::size_t width) {
    values.erase(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(first * width));
  };
  if (first > 0) {
    for (Signal& signal : latest_.signals) forget(signal.rows, signal.layout.numbers);
    forget(latest_.time_ns, 1);
  }
  return anew;
}

void LiveView::show_pace() {
  const PaceState pace = pace_.state();
  const std::int64_t dropped = recorder_->dropped();
  if (pace_shown_ == pace && dropped_shown_ == dropped) return;
  pace_shown_ = pace;
  dropped_shown_ = dropped;
  const std::string told = settings_.speed ? json_members(pace) : "";
  feed_.publish(fmt::format(R"({{{}"not_shown": {}}})", told, dropped));
}

void LiveView::stop_thread() {
  stops_ = true;
  pace_.release();
  if (thread_.joinable()) thread_.join();
}

void LiveView::finish() {
  stop_thread();
  if (recorder_) show_samples();
  feed_.publish(R"({"over": true})");
  feed_.close();
}

void LiveView::finish(std::string report) {
  stop_thread();
  if (recorder_) show_samples();
  // Who has asked before the run began, and not come again yet, was told to.
  const bool is_awaited = server_.was_asked_early() && server_.viewers_so_far() == 0;
  const std::size_t viewers = server_.viewers() + (is_awaited ? 1 : 0);
  server_.show_report(std::move(report));
  feed_.publish(R"({"ended": true})");
  feed_.close();
  wait_until([&] { return server_.reports_fetched() >= viewers; });
}

}  // namespace flinch
