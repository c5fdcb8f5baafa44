#include "experiments/live_view/live_feed.h"

#include <algorithm>
#include <utility>

namespace flinch {

void LiveFeed::publish(std::string text) {
  auto message = std::make_shared<const std::string>(std::move(text));
  const std::scoped_lock lock(mutex_);
  bytes_ += message->size();
  messages_.push_back(std::move(message));
  ++published_;
  while (messages_.size() > 1 && (messages_.size() > most_messages_ || bytes_ > most_bytes_)) {
    bytes_ -= messages_.front()->size();
    messages_.pop_front();
  }
  more_.notify_all();
}

std::optional<LiveFeed::Message> LiveFeed::after(std::uint64_t seen,
                                                 std::chrono::milliseconds longest) const {
  std::unique_lock lock(mutex_);
  more_.wait_for(lock, longest, [&] { return closed_ || published_ > seen; });
  if (published_ <= seen) return std::nullopt;
  const std::uint64_t oldest = published_ - messages_.size() + 1;
  const std::uint64_t number = std::max(oldest, seen + 1);
  return Message{number, messages_[static_cast<std::size_t>(number - oldest)]};
}

void LiveFeed::close() {
  const std::scoped_lock lock(mutex_);
  closed_ = true;
  more_.notify_all();
}

bool LiveFeed::is_closed() const {
  const std::scoped_lock lock(mutex_);
  return closed_;
}

}  // namespace flinch
