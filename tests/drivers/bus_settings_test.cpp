#include "drivers/bus_settings.h"

#include <gmock/gmock.h>

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
