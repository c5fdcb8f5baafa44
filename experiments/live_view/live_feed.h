#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

namespace flinch {

/// The latest messages of a run, numbered from 1 on, for any number of viewers who read them each at a pace
/// of his own. Who publishes never waits for a viewer; one who is too far behind skips what is no longer
/// kept.
class LiveFeed {
 public:
  /// At most so many messages are kept, and of those at most so many bytes, but always the last.
  LiveFeed(std::size_t messages, std::size_t bytes) : most_messages_(messages), most_bytes_(bytes) {}

  struct Message {
    std::uint64_t number = 0;
    std::shared_ptr<const std::string> text;
  };

  void publish(std::string text);

  /// The first message that is kept after the one of number `seen`. Waits for it at most so long; none: there
  /// was none.
  std::optional<Message> after(std::uint64_t seen, std::chrono::milliseconds longest) const;

  /// There will be no more messages.
  void close();
  bool is_closed() const;

 private:
  std::size_t most_messages_;
  std::size_t most_bytes_;
  mutable std::mutex mutex_;
  mutable std::condition_variable more_;
  std::deque<std::shared_ptr<const std::string>> messages_;
  std::size_t bytes_ = 0;
  std::uint64_t published_ = 0;
  bool closed_ = false;
};

}  // namespace flinch
