#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "drivers/dds_bus.h"
#include "drivers/pace.h"
#include "systems/framework/monotonic_clock.h"

namespace flinch {

/// What a user of a served robot should know of the others on the bus, each once.
class BusWarnings {
 public:
  /// What is known of who commands.
  struct Commanders {
    int unreadable = 0;            ///< programs that command in another protocol
    std::uint32_t other_pace = 0;  ///< commands of programs that go by another pace
  };

  /// `ask` is called by news().
  BusWarnings(const DdsBus& bus, std::uint64_t robot_id, Pace pace, std::function<Commanders()> ask)
      : bus_(bus), robot_id_(robot_id), pace_(pace), ask_(std::move(ask)) {}

  /// Looks once a second.
  std::string news();

 private:
  std::string news_of_robots();
  std::string news_of(const Commanders& commanders);

  const DdsBus& bus_;
  std::uint64_t robot_id_;
  Pace pace_;
  std::function<Commanders()> ask_;
  Time next_look_ = MonotonicClock::now() + 500ms;
  int robots_ = 1;
  int unreadable_ = 0;
  int told_unreadable_ = 0;
  bool told_pace_ = false;
};

}  // namespace flinch
