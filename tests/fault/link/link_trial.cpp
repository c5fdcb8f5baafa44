#include "tests/fault/link/link_trial.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cstdlib>
#include <map>

#include "systems/framework/monotonic_clock.h"
#include "tests/support/free_domain.h"
#include "tests/support/two_networks.h"

namespace flinch::test {
namespace {

namespace fs = std::filesystem;

constexpr std::uint32_t moving_ticks = 300;

/// The programs bring their own bus; this one is for the taps.
BusSettings tapped_bus(std::uint32_t domain, const TwoNetworks* networks) {
  if (networks == nullptr) return {.domain = domain};
  return {.domain = domain,
          .interface = TwoNetworks::interface,
          .peers = {TwoNetworks::first_address, TwoNetworks::second_address},
          .anyone_may_command = true};
}

}  // namespace

std::string shipped_file(const std::string& name) { return FLINCH_SOURCE_DIR "/apps/" + name; }

TroubleFile::TroubleFile(const fs::path& file) {
  const int descriptor = ::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600);
  const bool sized = ::ftruncate(descriptor, sizeof(Trouble)) == 0;
  void* const memory = ::mmap(nullptr, sizeof(Trouble), PROT_READ | PROT_WRITE, MAP_SHARED, descriptor, 0);
  ::close(descriptor);
  if (!sized || memory == MAP_FAILED) throw std::runtime_error("no file for a trouble");
  trouble_ = static_cast<Trouble*>(memory);
}

TroubleFile::~TroubleFile() { ::munmap(trouble_, sizeof(Trouble)); }

LinkTrial::LinkTrial() : LinkTrial({}, nullptr) {}
LinkTrial::LinkTrial(OwnRobot robot) : LinkTrial(std::move(robot), nullptr) {}
LinkTrial::LinkTrial(const TwoNetworks& networks) : LinkTrial({}, &networks) {}

LinkTrial::LinkTrial(OwnRobot robot, const TwoNetworks* networks)
    : own_robot_(std::move(robot)),
      networks_(networks),
      domain_(free_domain()),
      trouble_(folder_ / "trouble") {
  const BusSettings bus = tapped_bus(domain_, networks_);
  robots_tap_ = std::make_unique<BusTap>(bus, networks_ != nullptr ? networks_->first() : "");
  if (networks_ != nullptr) commanders_tap_ = std::make_unique<BusTap>(bus, networks_->second());
}

LinkTrial::~LinkTrial() = default;

std::vector<std::string> LinkTrial::bus_arguments() const {
  std::vector<std::string> arguments = {"--domain", std::to_string(domain_)};
  if (networks_ == nullptr) return arguments;
  for (const char* word : {"--interface", TwoNetworks::interface, "--peer", TwoNetworks::first_address,
                           "--peer", TwoNetworks::second_address, "--anyone-may-command"}) {
    arguments.emplace_back(word);
  }
  return arguments;
}

std::unique_ptr<OtherProgram> LinkTrial::start(const std::vector<std::string>& arguments,
                                               const std::string& network) const {
  OtherProgram::Start start = flinch_program(arguments);
  start.environment = {{Trouble::variable, (folder_ / "trouble").string()}};
  start.preloaded = BAD_NETWORK;
  start.prepare = [network] { return enter_network(network); };
  return std::make_unique<OtherProgram>(start);
}

void LinkTrial::start_robot() {
  robot_.reset();
  if (own_robot_) {
    robot_ = std::make_unique<OtherProgram>([this] { own_robot_(domain_); });
    return;
  }
  std::vector<std::string> arguments = {"serve", shipped_file("scenarios/square.yaml"), "--robot", "bench",
                                        "--real-time"};
  for (const std::string& argument : bus_arguments()) arguments.push_back(argument);
  robot_ = start(arguments, networks_ != nullptr ? networks_->first() : "");
}

std::unique_ptr<OtherProgram> LinkTrial::other_commander(const std::vector<std::string>& arguments,
                                                         const std::string& scenario) const {
  std::vector<std::string> all = {"run", shipped_file(scenario), "--station", "dds"};
  for (const std::string& argument : bus_arguments()) all.push_back(argument);
  for (const std::string& argument : arguments) all.push_back(argument);
  return start(all, networks_ != nullptr ? networks_->second() : "");
}

void LinkTrial::start_commander() {
  commander_.reset();
  status_before_ = at_robot().status.count;
  commander_ = other_commander({"--out", (folder_ / "out").string()});
}

bool LinkTrial::wait_for_motion() {
  const Track<flinch_StatusSample>& status = at_robot().status;
  std::uint32_t seen = status_before_;
  std::uint32_t moving = 0;
  const auto has_stopped = [&] {
    while (seen < status.count) {
      if (status[seen++].braked == 0) {
        ++moving;
      } else if (moving > 0) {
        return true;
      }
    }
    return !commander_->is_running();
  };
  bool stopped = false;
  wait_until(10s, [&] { return (stopped = has_stopped()) || moving >= moving_ticks; });
  return !stopped && moving >= moving_ticks;
}

void LinkTrial::get_moving() { get_moving_with(true); }

void LinkTrial::get_moving_again() { get_moving_with(false); }

void LinkTrial::get_moving_with(bool new_robot) {
  for (int attempt = 0; attempt < 5; ++attempt) {
    if (new_robot) start_robot();
    start_commander();
    if (wait_for_motion()) return;
  }
  throw TooBusy("no run has got going: " + commander_->output());
}

}  // namespace flinch::test
