#pragma once

#include <cstdint>
#include <memory>

#include "diagrams/external_station.h"
#include "drivers/dds_bus.h"
#include "systems/framework/context.h"
#include "systems/framework/exchange.h"

namespace flinch {

struct DdsStationSettings {
  std::uint32_t robot =
      0;  ///< robot_hash() of the robot description: that of the other end, or nothing passes
  Time longest_silence = 100ms;  ///< after which another sender of readings is accepted
  int realtime_priority = 0;     ///< of the thread that sends, SCHED_FIFO, 1 to 99; 0: an ordinary thread
};

/// What the drives shall be, by an operator or a supervisor. CiA 402.
struct DriveWish {
  enum class State : std::uint8_t { without_voltage, switched_on, operation_enabled, quick_stop };
  State state = State::without_voltage;
  bool engage_brake = true;        ///< the brakes shall close whatever the torque commands say
  std::uint32_t fault_resets = 0;  ///< a larger number than before asks to reset a fault
};

/// How the link has been since the start.
struct DdsLink {
  int peers = 0;               ///< that send joint readings
  std::uint32_t received = 0;  ///< joint samples
  std::uint32_t refused = 0;   ///< samples of any kind: another protocol version, robot or sender, or old
  std::uint32_t other_version = 0;  ///< of these
  std::uint32_t other_robot = 0;
  bool commands_obeyed = false;  ///< the other end obeys this session
  Time round_trip{};             ///< of the last echoed command, without the time that the other end kept it
};

/// Carries an ExternalStation's readings from the bus and its commands to it. Receiving and sending happen on
/// other threads; what is called from the loop neither blocks, allocates nor throws.
///
/// A reading's stamp of acquisition is translated twice: from the sender's monotonic clock to ours by the
/// smallest delay seen (ClockMap), and to the time of the ticks by the most punctual tick (TickClock). It is
/// late by the smallest delay on the way. No wall clock takes part.
class DdsStation final : public Exchange {
 public:
  /// `diagram` is the one to run, with the inputs of `station`. Throws SetupError.
  DdsStation(const DdsBus& bus, const Diagram& diagram, const ExternalStation& station,
             const DdsStationSettings& settings);
  ~DdsStation() override;

  /// Sets the station's readings to what has arrived.
  void set_inputs(Context& context) override;
  /// Hands torque command and brake to the bus.
  void take_outputs(const Context& context) override;

  /// Asks for a state of the drives, until the next call. From one thread at a time, not from the loop.
  void request(const DriveWish& wish) noexcept;

  /// Of the thread that calls set_inputs(), or while it does not.
  DdsLink link() const noexcept;
  /// The session under which commands are sent.
  std::uint32_t session() const noexcept;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace flinch
