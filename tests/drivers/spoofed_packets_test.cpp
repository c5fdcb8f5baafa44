// Packets in the name of the controller, by somebody on the wire: what they do without security, what access
// control alone does about them, and the keys as they are made.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <iostream>

#include "tests/drivers/key_folder.h"
#include "tests/drivers/link_ends.h"
#include "tests/drivers/spoofer.h"
#include "tests/support/free_domain.h"
#include "tests/support/other_program.h"
#include "tests/support/shared_memory.h"

namespace flinch {
namespace {

using test::FarEnd;
using test::KeyFolder;
using test::NearEnd;
using test::OtherProgram;
using test::SharedMemory;
using test::Spoofing;

/// What the robot saw while somebody sent packets in the controller's name.
struct Seen {
  int ticks = 0;
  int obeyed = 0;              ///< with a torque of the controller
  int spoofed = 0;             ///< with that of the packets
  std::uint32_t received = 0;  ///< torque commands that came through the bus, whatever they met with
  std::uint32_t refused = 0;   ///< of these, by SampleAdmission
};

/// A pipe whose writer does not wait.
struct Pipe {
  Pipe() {
    if (::pipe(ends.data()) != 0) ends = {-1, -1};
    ::fcntl(ends[1], F_SETFL, O_NONBLOCK);
  }
  std::array<int, 2> ends{};
};

/// Lets robot, controller and spoofer run, the last one for 1.5 s.
Seen attack(const BusSettings& robots, const BusSettings& controllers, Spoofing& spoofing) {
  const Pipe wire;
  const OtherProgram controller([&] {
    test::capture_datagrams(wire.ends[1]);
    const DdsBus bus(controllers);
    NearEnd near(bus);
    near.run([] { return false; });
  });
  const OtherProgram spoofer([&] { test::spoof(wire.ends[0], spoofing); });
  const DdsBus bus(robots);
  FarEnd far(bus);
  int before = 0;
  far.run([&] { return (before += far.torque().valid ? 1 : 0) == 300; });

  Seen seen;
  const DdsCommander start = far.server().commander();
  spoofing.go = true;
  far.run([&] {
    const TorqueCommand& torque = far.torque();
    if (torque.valid) ++(torque.torque[0] == test::spoofed_torque ? seen.spoofed : seen.obeyed);
    return ++seen.ticks == 1500;
  });
  const DdsCommander end = far.server().commander();
  seen.refused = end.refused - start.refused;
  seen.received = end.received - start.received + seen.refused;
  return seen;
}

void print(const char* how, const Spoofing& spoofing, const Seen& seen) {
  std::cout << how << ": sent " << spoofing.forged << " forged, " << spoofing.stripped
            << " forged and stripped, " << spoofing.replayed << " replayed, " << spoofing.renumbered
            << " replayed under new numbers; in " << seen.ticks << " ticks the robot received "
            << seen.received << " commands, refused " << seen.refused << ", obeyed the controller in "
            << seen.obeyed << " and the packets in " << seen.spoofed << std::endl;
}

void expect_much_was_sent(const Spoofing& spoofing) {
  EXPECT_GT(spoofing.forged, 500u);
  EXPECT_GT(spoofing.stripped, 500u);
  EXPECT_GT(spoofing.replayed, 500u);
  EXPECT_GT(spoofing.renumbered, 500u);
}

/// Governance as it is made, but for the protection of samples.
void leave_samples_unprotected(std::string& governance, std::string&) {
  const std::string kind = "<metadata_protection_kind>SIGN_WITH_ORIGIN_AUTHENTICATION<";
  governance.replace(governance.find(kind), kind.size(), "<metadata_protection_kind>NONE<");
}

TEST(SpoofedPackets, CommandTheRobotOnABusWithoutSecurity) {
  const std::uint32_t domain = test::free_domain();
  const SharedMemory<Spoofing> spoofing;
  const Seen seen = attack({.domain = domain}, {.domain = domain}, *spoofing);
  print("without security", *spoofing, seen);
  expect_much_was_sent(*spoofing);
  EXPECT_GT(seen.spoofed, 500);
}

TEST(SpoofedPackets, CommandTheRobotUnderAccessControlAlone) {
  const std::uint32_t domain = test::free_domain();
  const KeyFolder keys;
  test::sign_anew(keys, &leave_samples_unprotected);
  const SharedMemory<Spoofing> spoofing;
  const Seen seen = attack({.domain = domain, .security = keys.of(BusRole::robot)},
                           {.domain = domain, .security = keys.of(BusRole::controller)}, *spoofing);
  print("access control without signatures", *spoofing, seen);
  expect_much_was_sent(*spoofing);
  EXPECT_GT(seen.spoofed, 500);
}

TEST(SpoofedPackets, HaveNoEffectWithTheKeysAsTheyAreMade) {
  const std::uint32_t domain = test::free_domain();
  const KeyFolder keys;
  const SharedMemory<Spoofing> spoofing;
  const Seen seen = attack({.domain = domain, .security = keys.of(BusRole::robot)},
                           {.domain = domain, .security = keys.of(BusRole::controller)}, *spoofing);
  print("with keys", *spoofing, seen);
  expect_much_was_sent(*spoofing);
  EXPECT_EQ(seen.spoofed, 0);
  EXPECT_GT(seen.obeyed, 1000);
  EXPECT_GT(seen.received, 1000u);  // the controller's own
  EXPECT_LE(seen.received, spoofing->captured);
}

}  // namespace
}  // namespace flinch
