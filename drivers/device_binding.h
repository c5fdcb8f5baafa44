#pragma once

#include <cstdint>
#include <string>

/// What a bus hears. Cyclone DDS takes an interface for sending only: its sockets receive what arrives at any
/// device.
namespace flinch {

/// The device of an interface that is given by its name or by an address of this machine ("lo" of
/// "127.0.0.1"); empty where there is none.
std::string network_device(const std::string& interface);

/// How a socket was made deaf to all devices but one.
enum class DeviceBinding : std::uint8_t {
  none,    ///< it was not: the system allows neither
  device,  ///< the system delivers nothing else to it (SO_BINDTODEVICE; without rights since Linux 5.7)
  filter,  ///< it drops what has arrived at another device (SO_ATTACH_FILTER; never needs rights)
};

/// Makes a socket hear `device` only, by the first of these ways that is allowed.
DeviceBinding bind_to_device(int socket, const std::string& device);
/// The second way alone.
DeviceBinding filter_device(int socket, const std::string& device);

/// Makes the bus `domain` of this program hear `device` only, and looks whether it does. To be called when
/// the domain has its sockets and no participant yet: what arrives before finds nobody who could believe it.
/// Throws SetupError where sockets are missing or cannot be bound.
void bind_bus_to_device(std::uint32_t domain, const std::string& device);

}  // namespace flinch
