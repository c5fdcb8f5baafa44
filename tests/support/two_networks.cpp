#include "tests/support/two_networks.h"

#include <fcntl.h>
#include <sched.h>
#include <unistd.h>

#include <cstdlib>

namespace flinch::test {
namespace {

bool ip(const std::string& arguments) {
  return std::system(("ip " + arguments + " >/dev/null 2>&1").c_str()) == 0;
}

bool equip(const std::string& network, const std::string& address) {
  return ip("-n " + network + " link set lo up") &&
         ip("-n " + network + " addr add " + address + "/24 dev flinch0") &&
         ip("-n " + network + " link set flinch0 up");
}

}  // namespace

TwoNetworks::TwoNetworks()
    : first_("flinch_a_" + std::to_string(::getpid())), second_("flinch_b_" + std::to_string(::getpid())) {
  const bool made =
      ip("netns add " + first_) && ip("netns add " + second_) &&
      ip("link add flinch0 netns " + first_ + " type veth peer name flinch0 netns " + second_) &&
      equip(first_, first_address) && equip(second_, second_address);
  if (!made) {
    missing_ =
        "no network namespaces with a cable between: they need the rights of an administrator, the program "
        "ip "
        "(iproute2) and veth in the kernel";
  }
}

TwoNetworks::~TwoNetworks() {
  ip("netns del " + first_);
  ip("netns del " + second_);
}

bool enter_network(const std::string& network) {
  if (network.empty()) return true;
  const int space = ::open(("/run/netns/" + network).c_str(), O_RDONLY | O_CLOEXEC);
  const bool entered = ::setns(space, CLONE_NEWNET) == 0;
  ::close(space);
  return entered;
}

void TwoNetworks::cut() const { ip("-n " + second_ + " link set flinch0 down"); }

}  // namespace flinch::test
