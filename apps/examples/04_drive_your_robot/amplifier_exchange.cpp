#include "apps/examples/04_drive_your_robot/amplifier_exchange.h"

using namespace flinch;

AmplifierExchange::AmplifierExchange(MyAmplifiers& amplifiers, const Diagram& diagram,
                                     const ExternalStation& fieldbus, const AmplifierStation& station)
    : amplifiers_(amplifiers),
      joints_(diagram.slot(fieldbus.arriving_joints)),
      drives_(diagram.slot(fieldbus.arriving_drives)),
      status_(diagram.slot(fieldbus.arriving_status)),
      statuswords_(diagram.slot(station.statuswords)),
      controlword_(diagram.slot(station.controlword)),
      torque_(diagram.slot(fieldbus.torque_command)),
      brake_(diagram.slot(fieldbus.brake)) {}

// Where the amplifiers do not answer, nothing new arrives, and their statuswords are gone: in this very tick
// there is no torque, and 3 ms later the readings are not valid any more.
void AmplifierExchange::set_inputs(Context& context) {
  const AmplifierReadings readings = amplifiers_.read();
  context[statuswords_] = {};
  if (readings.answered) set_readings(context, readings);
}

void AmplifierExchange::set_readings(Context& context, const AmplifierReadings& readings) {
  const Time acquired = context.time();  // earlier, if your amplifiers latch earlier and say so
  ++number_;
  context[joints_] = {.reading = {.acquired = acquired,
                                  .valid = true,
                                  .passive_valid = readings.passive.size() > 0,
                                  .active = readings.active,
                                  .passive = readings.passive},
                      .source = 1,
                      .number = number_};
  context[drives_] = {.reading = {.acquired = acquired, .valid = true, .current = readings.current},
                      .source = 1,
                      .number = number_};
  context[status_] = {.reading = {.acquired = acquired,
                                  .valid = true,
                                  .enabled = true,  // the drives' states say the rest
                                  .braked = readings.braked,
                                  .fault = readings.fault},
                      .source = 1,
                      .number = number_};
  Statuswords& told = context[statuswords_];
  told.count = static_cast<std::uint8_t>(readings.statuswords.size());
  std::copy(readings.statuswords.begin(), readings.statuswords.end(), told.bits.begin());
}

void AmplifierExchange::take_outputs(const Context& context) {
  const TorqueCommand& torque = context[torque_];
  const bool usable = torque.valid && torque.torque.size() == 3 && torque.torque.allFinite();
  AmplifierOrders orders;
  orders.controlword = context[controlword_].bits;
  orders.close_brakes = context[brake_].engage || !usable;
  if (!orders.close_brakes) orders.torque = torque.torque;
  has_driven_ = has_driven_ || !orders.close_brakes;
  amplifiers_.write(orders);
}
