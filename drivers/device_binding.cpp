#include "drivers/device_binding.h"

#include <arpa/inet.h>
#include <ifaddrs.h>
#include <linux/filter.h>
#include <net/if.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstring>
#include <filesystem>
#include <memory>
#include <system_error>
#include <vector>

#include "systems/foundation/setup_error.h"

namespace flinch {
namespace {

int option(int socket, int name) {
  int value = -1;
  socklen_t size = sizeof(value);
  return ::getsockopt(socket, SOL_SOCKET, name, &value, &size) == 0 ? value : -1;
}

std::string bound_device(int socket) {
  std::array<char, IFNAMSIZ> name{};
  socklen_t size = name.size();
  if (::getsockopt(socket, SOL_SOCKET, SO_BINDTODEVICE, name.data(), &size) != 0) return "";
  return {name.data(), ::strnlen(name.data(), size)};
}

/// DDSI-RTPS 2.3, 9.6.1.1: the ports of a domain.
constexpr std::uint32_t first_port(std::uint32_t domain) { return 7400 + 250 * domain; }
constexpr std::uint32_t ports_of_domain = 250;

/// Whether a socket receives datagrams for all addresses at a port of the domain.
bool receives_for(std::uint32_t domain, int socket) {
  if (option(socket, SO_TYPE) != SOCK_DGRAM || option(socket, SO_DOMAIN) != AF_INET) return false;
  sockaddr_in address{};
  socklen_t size = sizeof(address);
  if (::getsockname(socket, reinterpret_cast<sockaddr*>(&address), &size) != 0) return false;
  const std::uint32_t port = ntohs(address.sin_port);
  return address.sin_addr.s_addr == htonl(INADDR_ANY) && port >= first_port(domain) &&
         port < first_port(domain) + ports_of_domain;
}

std::vector<int> receive_sockets(std::uint32_t domain) {
  std::vector<int> sockets;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator("/proc/self/fd", error)) {
    const std::string name = entry.path().filename().string();
    int descriptor = -1;
    std::from_chars(name.data(), name.data() + name.size(), descriptor);
    if (descriptor >= 0 && receives_for(domain, descriptor)) sockets.push_back(descriptor);
  }
  return sockets;
}

}  // namespace

std::string network_device(const std::string& interface) {
  if (::if_nametoindex(interface.c_str()) != 0) return interface;
  ifaddrs* list = nullptr;
  if (::getifaddrs(&list) != 0) return "";
  const std::unique_ptr<ifaddrs, void (*)(ifaddrs*)> owner(list, &::freeifaddrs);
  in_addr wanted{};
  if (::inet_pton(AF_INET, interface.c_str(), &wanted) != 1) return "";
  for (const ifaddrs* each = list; each != nullptr; each = each->ifa_next) {
    if (each->ifa_addr == nullptr || each->ifa_addr->sa_family != AF_INET) continue;
    const auto* const address = reinterpret_cast<const sockaddr_in*>(each->ifa_addr);
    if (address->sin_addr.s_addr == wanted.s_addr) return each->ifa_name;
  }
  return "";
}

DeviceBinding bind_to_device(int socket, const std::string& device) {
  if (bound_device(socket) == device) return DeviceBinding::device;
  const auto size = static_cast<socklen_t>(device.size());
  if (::setsockopt(socket, SOL_SOCKET, SO_BINDTODEVICE, device.data(), size) == 0 &&
      bound_device(socket) == device) {
    return DeviceBinding::device;
  }
  return filter_device(socket, device);
}

DeviceBinding filter_device(int socket, const std::string& device) {
  const unsigned index = ::if_nametoindex(device.c_str());
  const auto arrival_device = static_cast<std::uint32_t>(SKF_AD_OFF + SKF_AD_IFINDEX);
  std::array<sock_filter, 4> program = {{
      BPF_STMT(BPF_LD | BPF_W | BPF_ABS, arrival_device), BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, index, 0, 1),
      BPF_STMT(BPF_RET | BPF_K, 0xffffffff),  // whole
      BPF_STMT(BPF_RET | BPF_K, 0),           // dropped
  }};
  const sock_fprog filter{program.size(), program.data()};
  const bool attached =
      index != 0 && ::setsockopt(socket, SOL_SOCKET, SO_ATTACH_FILTER, &filter, sizeof(filter)) == 0;
  return attached ? DeviceBinding::filter : DeviceBinding::none;
}

void bind_bus_to_device(std::uint32_t domain, const std::string& device) {
  const std::string bus = "the bus " + std::to_string(domain);
  // One for discovery and one for samples, and as many again where there is multicast.
  const std::vector<int> sockets = receive_sockets(domain);
  if (sockets.size() < 2) {
    throw SetupError(bus + " has no sockets that can be kept to the device '" + device +
                     "': this version of Cyclone DDS receives in another way, and the network could command "
                     "the robot");
  }
  const bool bound = std::all_of(sockets.begin(), sockets.end(), [&device](int socket) {
    return bind_to_device(socket, device) != DeviceBinding::none;
  });
  if (bound) return;
  throw SetupError(bus + " would hear more than the device '" + device +
                   "': the system lets no socket be bound to a device (SO_BINDTODEVICE) or filtered by it "
                   "(SO_ATTACH_FILTER); run it where one of them is allowed");
}

}  // namespace flinch
