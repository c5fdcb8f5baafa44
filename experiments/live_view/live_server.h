#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

namespace flinch {

class LiveFeed;

struct LiveServerSettings {
  int port = 0;                           ///< of the loopback interface; 0: one that is free
  std::size_t viewers = 8;                ///< most that read the feed at a time
  std::chrono::milliseconds stall{2000};  ///< after which a viewer is dropped who takes nothing
};

/// Serves one run to browsers on this computer: a page, the messages of a feed as server-sent events, orders,
/// and in the end the report. On threads of its own.
///
/// The address holds a random token of 128 bits. A request that does not name it, or that came by another
/// name of the host, is answered by an empty 403.
class LiveServer {
 public:
  /// Follows an order of a page; false: it is none.
  using Order = std::function<bool(std::string_view order)>;

  /// Without an `order`, orders are answered by 404. `feed` must outlive this. Throws SetupError where the
  /// port cannot be had.
  LiveServer(const LiveFeed& feed, Order order, const LiveServerSettings& settings = {});
  ~LiveServer();
  LiveServer(const LiveServer&) = delete;
  LiveServer& operator=(const LiveServer&) = delete;

  /// "http://127.0.0.1:PORT/TOKEN/"
  const std::string& address() const;

  /// What the address shows; who asks before is told to wait for it.
  void show_page(std::string html);
  /// What `report.html` below the address is. None before.
  void show_report(std::string html);

  /// Who reads the feed now, and how often somebody has begun to.
  std::size_t viewers() const;
  std::size_t viewers_so_far() const;
  /// Whether somebody has asked for the page before it was there.
  bool was_asked_early() const;
  /// How often the report was fetched.
  std::size_t reports_fetched() const;

 private:
  class Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace flinch
