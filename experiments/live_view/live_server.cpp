#include "experiments/live_view/live_server.h"

#include <httplib.h>
#include <sys/random.h>

#include <array>
#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

#include "experiments/live_view/give_way.h"
#include "experiments/live_view/live_feed.h"
#include "systems/foundation/setup_error.h"

namespace flinch {
namespace {

constexpr const char* loopback = "127.0.0.1";
constexpr std::size_t other_requests = 4;  // that are answered besides viewers who read
constexpr std::size_t waiting_requests = 32;
constexpr std::size_t most_body = 256;  // bytes of an order
constexpr std::chrono::milliseconds heartbeat{500};
constexpr std::chrono::seconds page_patience{1};
constexpr const char* no_page_yet =
    "<!DOCTYPE html><meta http-equiv=\"refresh\" content=\"1\"><link rel=\"icon\" href=\"data:,\">"
    "<title>flinch live</title><p>The run has not begun.";

std::string random_token() {
  std::array<unsigned char, 16> bytes{};
  if (getrandom(bytes.data(), bytes.size(), 0) != static_cast<ssize_t>(bytes.size()))
    throw SetupError("the live view needs random numbers, and the system gives none");
  constexpr std::string_view digits = "0123456789abcdef";
  std::string token;
  for (const unsigned char byte : bytes) {
    token += digits[byte >> 4];
    token += digits[byte & 15];
  }
  return token;
}

/// A port whose last user has gone can be had at once, one that somebody has cannot.
void share_with_nobody(int socket) {
  const int yes = 1;
  setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
}

/// In a time that does not tell where they differ.
bool begins_with(std::string_view text, std::string_view secret) {
  if (text.size() < secret.size()) return false;
  unsigned difference = 0;
  for (std::size_t i = 0; i < secret.size(); ++i)
    difference |= static_cast<unsigned char>(text[i]) ^ static_cast<unsigned char>(secret[i]);
  return difference == 0;
}

/// Threads that answer requests. Where too many wait, nobody is let in until one is done.
class RequestThreads : public httplib::TaskQueue {
 public:
  explicit RequestThreads(std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) threads_.emplace_back([this] { work(); });
  }

  void enqueue(std::function<void()> request) override {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return ends_ || requests_.size() < waiting_requests; });
    requests_.push_back(std::move(request));
    changed_.notify_all();
  }

  void shutdown() override {
    {
      const std::scoped_lock lock(mutex_);
      ends_ = true;
      changed_.notify_all();
    }
    for (std::thread& thread : threads_) thread.join();
  }

 private:
  /// None: that was all.
  std::function<void()> next() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return ends_ || !requests_.empty(); });
    if (requests_.empty()) return nullptr;
    std::function<void()> request = std::move(requests_.front());
    requests_.pop_front();
    changed_.notify_all();
    return request;
  }
  void work() {
    while (const std::function<void()> request = next()) request();
  }

  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<std::function<void()>> requests_;
  bool ends_ = false;
  std::vector<std::thread> threads_;
};

}  // namespace

class LiveServer::Parts {
 public:
  Parts(const LiveFeed& feed, Order order, const LiveServerSettings& settings)
      : feed_(feed), order_(std::move(order)), settings_(settings), root_("/" + random_token() + "/") {
    set_up();
    listen_on_port();
    thread_ = std::thread([this] {
      give_way();
      server_.listen_after_bind();
    });
  }

  ~Parts() {
    {
      const std::scoped_lock lock(mutex_);
      ends_ = true;
      shown_.notify_all();
    }
    while (!server_.is_running()) std::this_thread::yield();  // stop() of one that does not run is lost
    server_.stop();
    thread_.join();
  }
  Parts(const Parts&) = delete;
  Parts& operator=(const Parts&) = delete;

  void show(std::string& place, std::string html) {
    const std::scoped_lock lock(mutex_);
    place = std::move(html);
    shown_.notify_all();
  }

 private:
  void set_up() {
    const std::size_t threads = settings_.viewers + other_requests;
    server_.new_task_queue = [threads] { return new RequestThreads(threads); };
    server_.set_socket_options(share_with_nobody);
    server_.set_keep_alive_timeout(1);    // s, for the first request as well
    server_.set_keep_alive_max_count(1);  // a connection that waits for its next request would hold a thread
    server_.set_read_timeout(std::chrono::seconds(1));
    server_.set_write_timeout(settings_.stall);
    server_.set_payload_max_length(most_body);
    server_.set_tcp_nodelay(true);
    server_.set_default_headers({{"Cache-Control", "no-store"},
                                 {"Referrer-Policy", "no-referrer"},
                                 {"X-Content-Type-Options", "nosniff"},
                                 {"X-Frame-Options", "DENY"},
                                 {"Cross-Origin-Resource-Policy", "same-origin"}});
    server_.set_pre_routing_handler([this](const httplib::Request& request, httplib::Response& response) {
      return admit(request, response);
    });
    server_.Get(root_, [this](const auto& /*request*/, auto& response) { answer_page(response); });
    server_.Get(root_ + "report.html",
                [this](const auto& /*request*/, auto& response) { answer_report(response); });
    server_.Get(root_ + "feed", [this](const auto& /*request*/, auto& response) { answer_feed(response); });
    server_.Post(root_ + "order",
                 [this](const auto& request, auto& response) { answer_order(request, response); });
  }

  void listen_on_port() {
    port_ = settings_.port;
    if (port_ == 0)
      port_ = server_.bind_to_any_port(loopback);
    else if (!server_.bind_to_port(loopback, port_))
      port_ = -1;
    if (port_ <= 0) {
      throw SetupError("--live: the port " + std::to_string(settings_.port) + " of " + loopback +
                       " cannot be had; another program has it, or it is below 1024");
    }
    address_ = std::string("http://") + loopback + ":" + std::to_string(port_) + root_;
  }

  /// A page of another site that gives its own name this address is told from ours by the name.
  bool is_our_name(const httplib::Request& request) const {
    const std::string port = ":" + std::to_string(port_);
    if (request.get_header_value_count("Host") != 1) return false;
    const std::string host = request.get_header_value("Host");
    return host == loopback + port || host == "localhost" + port;
  }

  httplib::Server::HandlerResponse admit(const httplib::Request& request, httplib::Response& response) const {
    if (is_our_name(request) && begins_with(request.path, root_))
      return httplib::Server::HandlerResponse::Unhandled;
    response.status = 403;
    return httplib::Server::HandlerResponse::Handled;
  }

  void answer_page(httplib::Response& response) {
    std::unique_lock lock(mutex_);
    if (!shown_.wait_for(lock, page_patience, [this] { return ends_ || !page.empty(); }) || page.empty()) {
      was_asked_early = true;
      response.status = 503;
      response.set_content(no_page_yet, "text/html; charset=utf-8");
      return;
    }
    response.set_content(page, "text/html; charset=utf-8");
  }

  void answer_report(httplib::Response& response) {
    const std::scoped_lock lock(mutex_);
    if (report.empty()) {
      response.status = 404;
      return;
    }
    response.set_content(report, "text/html; charset=utf-8");
    ++reports_fetched;
  }

  void answer_order(const httplib::Request& request, httplib::Response& response) const {
    if (!order_)
      response.status = 404;
    else
      response.status = order_(request.body) ? 204 : 400;
  }

  void answer_feed(httplib::Response& response) {
    if (viewers.fetch_add(1) >= settings_.viewers) {
      --viewers;
      response.status = 503;
      return;
    }
    ++viewers_so_far;
    response.set_chunked_content_provider(
        "text/event-stream",
        [this, seen = std::uint64_t{0}](std::size_t /*offset*/, httplib::DataSink& sink) mutable {
          return send_next(seen, sink);
        },
        [this](bool /*whole*/) { --viewers; });
  }

  /// The next message, or a comment, by which it shows whether the viewer is still there. False: he is not.
  bool send_next(std::uint64_t& seen, httplib::DataSink& sink) const {
    const std::optional<LiveFeed::Message> message = feed_.after(seen, heartbeat);
    if (!message && feed_.is_closed()) {
      sink.done();
      return true;
    }
    if (!message) return send(": \n\n", sink);
    seen = message->number;
    return send("data: " + *message->text + "\n\n", sink);
  }

  static bool send(const std::string& text, httplib::DataSink& sink) {
    return sink.is_writable() && sink.write(text.data(), text.size());
  }

  const LiveFeed& feed_;
  Order order_;
  LiveServerSettings settings_;
  std::string root_;
  int port_ = 0;
  std::mutex mutex_;
  std::condition_variable shown_;
  bool ends_ = false;
  httplib::Server server_;
  std::thread thread_;
  std::string address_;

 public:
  const std::string& address() const { return address_; }
  std::string page;    ///< under the mutex; see show()
  std::string report;  ///< likewise
  std::atomic<std::size_t> viewers = 0;
  std::atomic<std::size_t> viewers_so_far = 0;
  std::atomic<std::size_t> reports_fetched = 0;
  std::atomic<bool> was_asked_early = false;
};

LiveServer::LiveServer(const LiveFeed& feed, Order order, const LiveServerSettings& settings)
    : parts_(std::make_unique<Parts>(feed, std::move(order), settings)) {}

LiveServer::~LiveServer() = default;

const std::string& LiveServer::address() const { return parts_->address(); }
void LiveServer::show_page(std::string html) { parts_->show(parts_->page, std::move(html)); }
void LiveServer::show_report(std::string html) { parts_->show(parts_->report, std::move(html)); }
std::size_t LiveServer::viewers() const { return parts_->viewers; }
std::size_t LiveServer::viewers_so_far() const { return parts_->viewers_so_far; }
bool LiveServer::was_asked_early() const { return parts_->was_asked_early; }
std::size_t LiveServer::reports_fetched() const { return parts_->reports_fetched; }

}  // namespace flinch
