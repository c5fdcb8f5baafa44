#include "drivers/bus_settings.h"

#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <sys/socket.h>
#include <unistd.h>

#include <string>
#include <vector>

#include "drivers/dds_bus.h"
#include "systems/foundation/setup_error.h"
#include "tests/support/free_domain.h"

namespace flinch {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::SizeIs;

TEST(BusSettings, KeepTheBusOnThisMachineUnlessToldOtherwise) {
  const std::string configuration = cyclone_configuration({});
  EXPECT_THAT(configuration, HasSubstr("name=\"lo\" multicast=\"false\""));
  EXPECT_THAT(configuration, HasSubstr("<AllowMulticast>false"));
  EXPECT_THAT(configuration, HasSubstr("<Peer address=\"127.0.0.1\"/>"));
  EXPECT_THAT(warnings({}), IsEmpty());
}

TEST(BusSettings, WarnOfABusThatOthersCanReach) {
  const BusSettings settings{.interface = "eth0", .anyone_may_command = true};
  EXPECT_THAT(problems(settings), IsEmpty());
  EXPECT_THAT(warnings(settings), ElementsAre(HasSubstr("'eth0'")));
  EXPECT_THAT(cyclone_configuration(settings), Not(HasSubstr("Peer")));
}

TEST(BusSettings, NameAnInterfaceByItsAddressAndPeersWhereThereIsNoMulticast) {
  const std::string configuration =
      cyclone_configuration({.interface = "192.168.1.7", .peers = {"192.168.1.8"}});
  EXPECT_THAT(configuration, HasSubstr("address=\"192.168.1.7\" multicast=\"false\""));
  EXPECT_THAT(configuration, HasSubstr("<Peer address=\"192.168.1.8\"/>"));
}

TEST(BusSettings, RefuseANetworkWithoutKeysUnlessAnyoneMayCommand) {
  EXPECT_THAT(problems({.interface = "eth0"}), ElementsAre(HasSubstr("--anyone-may-command")));
  EXPECT_THAT(problems({.interface = "127.0.0.1"}), IsEmpty());
}

TEST(BusSettings, RefuseEverythingThatMakesNoBus) {
  EXPECT_THAT(problems({.domain = 231, .interface = "eth0\"/>", .peers = {"a b"}, .realtime_priority = 100}),
              SizeIs(5));
  EXPECT_THAT(problems({.peers = {"10.0.0.1"}}), SizeIs(1));
}

TEST(DdsBus, SaysWhatIsWrongWithItsInterface) {
  try {
    const DdsBus bus({.domain = test::free_domain(), .interface = "nowhere7", .anyone_may_command = true});
    FAIL();
  } catch (const SetupError& error) {
    EXPECT_THAT(error.what(), HasSubstr("'nowhere7'"));
  }
}

/// Sockets at the ports of the first `places` programs of a domain.
class TakenPlaces {
 public:
  TakenPlaces(std::uint32_t domain, int places) {
    for (int place = 0; place < places; ++place) {
      const int port = 7400 + 250 * static_cast<int>(domain) + 10 + 2 * place;  // DDSI-RTPS 2.3, 9.6.1.1
      sockets_.push_back(::socket(AF_INET, SOCK_DGRAM, 0));
      sockaddr_in address{};
      address.sin_family = AF_INET;
      address.sin_port = htons(static_cast<std::uint16_t>(port));
      const auto* const to = reinterpret_cast<const sockaddr*>(&address);
      EXPECT_EQ(::bind(sockets_.back(), to, sizeof(address)), 0) << port;
    }
  }
  TakenPlaces(const TakenPlaces&) = delete;
  TakenPlaces& operator=(const TakenPlaces&) = delete;
  ~TakenPlaces() {
    for (const int socket : sockets_) ::close(socket);
  }

 private:
  std::vector<int> sockets_;
};

TEST(DdsBus, FindsAPlaceBesideManyOtherPrograms) {
  const std::uint32_t domain = test::free_domain();
  const TakenPlaces others(domain, programs_of_domain - 1);
  EXPECT_NO_THROW(DdsBus({.domain = domain}));
}

TEST(DdsBus, SaysThatThereIsNoPlaceLeft) {
  const std::uint32_t domain = test::free_domain();
  const TakenPlaces others(domain, programs_of_domain);
  try {
    const DdsBus bus({.domain = domain});
    FAIL();
  } catch (const SetupError& error) {
    EXPECT_THAT(error.what(), HasSubstr("119 programs"));
    EXPECT_THAT(error.what(), HasSubstr("another --domain"));
  }
}

TEST(BusSettings, KeepTheirPortsWithinThoseOfTheDomain) {
  constexpr int last = 10 + 2 * programs_of_domain + 1;  // DDSI-RTPS 2.3, 9.6.1.1
  EXPECT_LT(last, 250) << "also of the place behind the last, where Cyclone DDS looks for peers";
  EXPECT_LT(7400 + 250 * 230 + last, 65536);
  EXPECT_THAT(cyclone_configuration({}),
              HasSubstr("<MaxAutoParticipantIndex>" + std::to_string(programs_of_domain) + "<"));
}

TEST(DdsBus, IsThereOnceADomainInAProgram) {
  const std::uint32_t domain = test::free_domain();
  {
    const DdsBus bus({.domain = domain});
    EXPECT_THROW(DdsBus({.domain = domain}), SetupError);
  }
  EXPECT_NO_THROW(DdsBus({.domain = domain}));
}

}  // namespace
}  // namespace flinch
