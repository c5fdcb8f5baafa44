#include "drivers/bus_settings.h"

#include <algorithm>
#include <cctype>
#include <utility>

namespace flinch {
namespace {

bool is_loopback(const BusSettings& settings) {
  return settings.interface == "lo" || settings.interface == "127.0.0.1";
}

/// What interface names and addresses consist of; nothing of it means anything in XML.
bool is_address(const std::string& text) {
  return !text.empty() && std::all_of(text.begin(), text.end(), [](unsigned char letter) {
    return std::isalnum(letter) != 0 || letter == '.' || letter == ':' || letter == '-' || letter == '_';
  });
}

std::string network(const BusSettings& settings) {
  const bool is_number = std::isdigit(static_cast<unsigned char>(settings.interface.front())) != 0;
  const std::string attribute = is_number ? "address" : "name";
  const bool multicast = !is_loopback(settings) && settings.peers.empty();
  return "<General><Interfaces><NetworkInterface " + attribute + "=\"" + settings.interface +
         "\" multicast=\"" + (multicast ? "default" : "false") + "\"/></Interfaces><AllowMulticast>" +
         (multicast ? "default" : "false") + "</AllowMulticast></General>";
}

std::string discovery(const BusSettings& settings) {
  std::vector<std::string> peers = settings.peers;
  if (is_loopback(settings)) peers = {"127.0.0.1"};
  if (peers.empty()) return "";
  std::string list;
  for (const std::string& peer : peers) list += "<Peer address=\"" + peer + "\"/>";
  return "<Discovery><ParticipantIndex>auto</ParticipantIndex><MaxAutoParticipantIndex>" +
         std::to_string(programs_of_domain) + "</MaxAutoParticipantIndex><Peers>" + list +
         "</Peers></Discovery>";
}

}  // namespace

std::vector<std::string> problems(const BusSettings& settings) {
  std::vector<std::string> found;
  if (settings.domain > 230) found.push_back("the domain of the bus must be 0 to 230");
  if (!is_address(settings.interface)) {
    found.push_back("'" + settings.interface + "' is neither name nor address of a network interface");
  }
  for (const std::string& peer : settings.peers) {
    if (!is_address(peer)) found.push_back("the peer '" + peer + "' is no address");
  }
  if (is_loopback(settings) && !settings.peers.empty()) {
    found.push_back("a bus on the loopback interface has no peers on other machines");
  }
  if (settings.realtime_priority < 0 || settings.realtime_priority > 99) {
    found.push_back("the real-time priority of the bus must be 1 to 99, or 0 for none");
  }
  if (!is_loopback(settings) && !settings.security && !settings.anyone_may_command) {
    found.push_back(
        "whoever reaches the interface '" + settings.interface +
        "' could command the robot: give both ends keys ('flinch keys' makes them, --security uses "
        "them), or allow it with --anyone-may-command");
  }
  if (settings.security) {
    for (std::string& problem : key_problems(*settings.security)) found.push_back(std::move(problem));
  }
  return found;
}

std::vector<std::string> warnings(const BusSettings& settings) {
  if (settings.security) return key_warnings(*settings.security);
  if (is_loopback(settings)) return {};
  return {"whoever reaches the interface '" + settings.interface +
          "' can command the robot: the bus leaves this machine without security; 'flinch keys' makes keys "
          "for it"};
}

std::string cyclone_configuration(const BusSettings& settings) {
  return "<CycloneDDS xmlns=\"https://cdds.io/config\"><Domain Id=\"any\">" + network(settings) +
         discovery(settings) + "</Domain></CycloneDDS>";
}

}  // namespace flinch
