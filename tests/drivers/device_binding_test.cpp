#include "drivers/device_binding.h"

#include <arpa/inet.h>
#include <fcntl.h>
#include <gmock/gmock.h>
#include <net/if.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <iostream>

#include "systems/foundation/setup_error.h"
#include "tests/drivers/link_ends.h"
#include "tests/drivers/outsider.h"
#include "tests/support/free_domain.h"
#include "tests/support/other_program.h"
#include "tests/support/shared_memory.h"
#include "tests/support/two_networks.h"

namespace flinch {
namespace {

using test::FarEnd;
using test::NearEnd;
using test::OtherProgram;
using test::Outsider;
using test::SharedMemory;
using test::TwoNetworks;

/// A socket that receives on 127.0.0.1, and one that sends there.
class Pair {
 public:
  Pair() {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof(address);
    auto* const generic = reinterpret_cast<sockaddr*>(&address);
    EXPECT_EQ(::bind(receiver_, generic, size), 0);
    EXPECT_EQ(::getsockname(receiver_, generic, &size), 0);
    EXPECT_EQ(::connect(sender_, generic, size), 0);
  }
  Pair(const Pair&) = delete;
  Pair& operator=(const Pair&) = delete;
  ~Pair() {
    ::close(receiver_);
    ::close(sender_);
  }

  int receiver() const { return receiver_; }
  bool hears() const {
    EXPECT_EQ(::send(sender_, "x", 1, 0), 1);
    pollfd ready{.fd = receiver_, .events = POLLIN, .revents = 0};
    char byte = 0;
    return ::poll(&ready, 1, 50) == 1 && ::recv(receiver_, &byte, 1, 0) == 1;
  }

 private:
  int receiver_ = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  int sender_ = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
};

TEST(DeviceBinding, FindsADeviceByItsNameAndByItsAddress) {
  EXPECT_EQ(network_device("lo"), "lo");
  EXPECT_EQ(network_device("127.0.0.1"), "lo");
  EXPECT_EQ(network_device("nowhere7"), "");
  EXPECT_EQ(network_device("203.0.113.9"), "");
}

TEST(DeviceBinding, LetsASocketHearItsDeviceWithoutRights) {
  const Pair pair;
  EXPECT_EQ(bind_to_device(pair.receiver(), "lo"), DeviceBinding::device);
  EXPECT_TRUE(pair.hears());
  EXPECT_EQ(bind_to_device(pair.receiver(), "lo"), DeviceBinding::device) << "a second time";
}

TEST(DeviceBinding, FiltersByTheDeviceOfArrival) {
  const Pair pair;
  EXPECT_EQ(filter_device(pair.receiver(), "lo"), DeviceBinding::filter);
  EXPECT_TRUE(pair.hears());
  EXPECT_EQ(filter_device(pair.receiver(), "nowhere7"), DeviceBinding::none);
}

TEST(DeviceBinding, FilterDropsWhatArrivesElsewhere) {
  std::array<char, IF_NAMESIZE> other{};
  for (unsigned index = 1; index < 64 && other[0] == 0; ++index) {
    if (::if_indextoname(index, other.data()) == nullptr || std::string(other.data()) == "lo") other[0] = 0;
  }
  if (other[0] == 0) GTEST_SKIP() << "this machine has no device but lo";
  const Pair pair;
  EXPECT_EQ(filter_device(pair.receiver(), other.data()), DeviceBinding::filter);
  EXPECT_FALSE(pair.hears());
}

TEST(DeviceBinding, RefusesABusWithoutSocketsThatItKnows) {
  EXPECT_THROW(bind_bus_to_device(test::free_domain(), "lo"), SetupError);
}

TEST(DeviceBinding, LeavesNoSocketOfALoopbackBusThatHearsOtherDevices) {
  const std::uint32_t domain = test::free_domain();
  const DdsBus bus({.domain = domain});
  int receiving = 0;
  for (int descriptor = 0; descriptor < 256; ++descriptor) {
    sockaddr_in address{};
    socklen_t size = sizeof(address);
    if (::getsockname(descriptor, reinterpret_cast<sockaddr*>(&address), &size) != 0) continue;
    const std::uint32_t port = ntohs(address.sin_port);
    if (address.sin_family != AF_INET || port < 7400 + 250 * domain || port >= 7650 + 250 * domain) continue;
    std::array<char, IF_NAMESIZE> device{};
    size = device.size();
    EXPECT_EQ(::getsockopt(descriptor, SOL_SOCKET, SO_BINDTODEVICE, device.data(), &size), 0);
    EXPECT_STREQ(device.data(), "lo") << "port " << port;
    ++receiving;
  }
  EXPECT_GE(receiving, 2);
}

/// What a robot saw while an outsider sent packets at it.
struct Seen {
  std::uint32_t commands = 0;  ///< torque commands that came through the bus
  std::uint32_t spoofed = 0;   ///< ticks with the torque of the outsider
  std::uint32_t ticks = 0;     ///< in all
  std::uint32_t sent = 0;      ///< packets of the outsider
};

/// Lets an outsider who has heard nothing of the robot command it from the other end of a cable.
Seen attack(const TwoNetworks& networks, const BusSettings& robots) {
  const SharedMemory<Outsider> outsider;
  const SharedMemory<Seen> seen;
  const OtherProgram attacker(
      [&] { outsider->attack_from(networks.second(), TwoNetworks::first_address, robots.domain); });
  {
    const OtherProgram controller([&] {
      outsider->overhear();
      const DdsBus bus({.domain = robots.domain});
      NearEnd(bus).run([] { return false; });
    });
    const OtherProgram rehearsing([&] {
      const DdsBus bus({.domain = robots.domain});
      outsider->rehearses = true;
      FarEnd(bus).run([] { return false; });
    });
    EXPECT_TRUE(outsider->wait_until_heard_enough());
  }
  OtherProgram robot([&] {
    if (!test::enter_network(networks.first())) return;
    const DdsBus bus(robots);
    FarEnd far(bus);
    outsider->robot_id = far.server().robot_id();
    far.run([&] {
      outsider->go = true;
      if (far.torque().valid && far.torque().torque[0] == test::spoofed_torque) ++seen->spoofed;
      seen->commands = far.server().commander().received + far.server().commander().refused;
      return outsider->sent >= Outsider::enough || ++seen->ticks == 60'000;
    });
  });
  EXPECT_EQ(robot.wait(120s), 0);
  seen->sent = outsider->sent;
  std::cout << "on " << robots.interface << ": " << seen->sent << " packets, " << seen->commands
            << " commands received, obeyed in " << seen->spoofed << " of " << seen->ticks << " ticks"
            << std::endl;
  return *seen;
}

TEST(Outsiders, CommandNothingThroughTheNetworkOnALoopbackBus) {
  const TwoNetworks networks;
  if (!networks.missing().empty()) GTEST_SKIP() << networks.missing();
  const Seen seen = attack(networks, {.domain = test::free_domain()});
  EXPECT_GE(seen.sent, Outsider::enough);
  EXPECT_EQ(seen.commands, 0u);
  EXPECT_EQ(seen.spoofed, 0u);
}

TEST(Outsiders, CommandARobotOfTheirNetworkWhereAnyoneMay) {
  const TwoNetworks networks;
  if (!networks.missing().empty()) GTEST_SKIP() << networks.missing();
  const Seen seen = attack(networks, {.domain = test::free_domain(),
                                      .interface = TwoNetworks::interface,
                                      .peers = {TwoNetworks::second_address},
                                      .anyone_may_command = true});
  EXPECT_GT(seen.spoofed, 100u) << "the packets of the other test would mean nothing";
}

}  // namespace
}  // namespace flinch
