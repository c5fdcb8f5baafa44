#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "systems/framework/time.h"
#include "systems/signals/imu_fault.h"

/// Inertial measurement units that fail while a realistic robot moves, and what becomes of it.
namespace flinch::test {

/// What happens to the unit: "late", "biased" and so on.
struct ImuFailure {
  std::string kind;
  ImuFault right;  ///< what it should be called
};
std::vector<ImuFailure> imu_failures();

struct ImuOutcome {
  bool stopped = false;         ///< the gate closed for a fault
  std::optional<Time> named{};  ///< from the first wrong sample
  std::optional<Time> shown{};  ///< from there to the first that errs by more than 0.3 m/s^2, if it is late
  ImuFault doubt = ImuFault::none;
  std::vector<std::string> false_contacts{};  ///< detectors that detected one before there was any
  std::vector<std::string> missed{};  ///< that did not within 100 ms of a contact, but do without the failure
  int contacts = 0;                   ///< detectors that notice it without the failure
  std::string told{};                 ///< the failure
};

/// A failure in random motion without contact, faster than 0.3 m/s; `number` draws robot, motion and size.
/// `stamps`: the range in which stamps of the unit err, and in which the control path is told that they do.
ImuOutcome fail_in_motion(const ImuFailure& failure, std::size_t number, Time stamps = {});
/// A failure up to 50 ms before a contact.
ImuOutcome fail_before_contact(const ImuFailure& failure, std::size_t number, Time stamps = {});

/// All outcomes of `count` failures of a kind.
std::vector<ImuOutcome> try_failures(const ImuFailure& failure, std::size_t count,
                                     ImuOutcome (*trial)(const ImuFailure&, std::size_t, Time),
                                     Time stamps = {});

/// What an honest unit is called in random motion of 2.5 s; none: nothing.
ImuFault doubt_of_honest_unit(std::size_t number, Time stamps);

/// Of `outcomes` in motion, those that were not named within 20 ms of the first sample that errs by more
/// than 0.3 m/s^2, 1 N of the platform's mass.
std::size_t named_late_since_shown(const std::vector<ImuOutcome>& outcomes);

/// The outcomes of a kind in a line of the table.
std::string table_of_failures_head();
std::string line_of(const ImuFailure& failure, const std::vector<ImuOutcome>& moving,
                    const std::vector<ImuOutcome>& touched);

}  // namespace flinch::test
