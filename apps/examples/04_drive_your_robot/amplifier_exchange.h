#pragma once

#include "apps/examples/04_drive_your_robot/my_amplifiers.h"
#include "drivers/amplifier_station.h"
#include "systems/framework/context.h"
#include "systems/framework/diagram.h"
#include "systems/framework/exchange.h"

/// Brings what the amplifiers tell into the diagram before a tick, and takes what they shall do away after
/// it. Nothing here depends on your fieldbus.
class AmplifierExchange final : public flinch::Exchange {
 public:
  /// All must outlive this.
  AmplifierExchange(MyAmplifiers& amplifiers, const flinch::Diagram& diagram,
                    const flinch::ExternalStation& fieldbus, const flinch::AmplifierStation& station);

  void set_inputs(flinch::Context& context) override;
  void take_outputs(const flinch::Context& context) override;

  /// Whether torque has reached the amplifiers.
  bool has_driven() const { return has_driven_; }

 private:
  void set_readings(flinch::Context& context, const AmplifierReadings& readings);

  MyAmplifiers& amplifiers_;
  flinch::Slot<flinch::Arrival<flinch::JointReading>> joints_;
  flinch::Slot<flinch::Arrival<flinch::DriveReading>> drives_;
  flinch::Slot<flinch::Arrival<flinch::StationStatus>> status_;
  flinch::Slot<flinch::Statuswords> statuswords_;
  flinch::Slot<flinch::Controlword> controlword_;
  flinch::Slot<flinch::TorqueCommand> torque_;
  flinch::Slot<flinch::BrakeCommand> brake_;
  std::uint32_t number_ = 0;
  bool has_driven_ = false;
};
