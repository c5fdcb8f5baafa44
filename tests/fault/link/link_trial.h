#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "drivers/bus_settings.h"
#include "tests/fault/link/bus_tap.h"
#include "tests/support/flinch_program.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/trouble.h"

namespace flinch::test {

class TwoNetworks;

/// The machine does not let a program run every millisecond.
struct TooBusy : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// A scenario that ships with the project, or a robot file: "scenarios/square.yaml".
std::string shipped_file(const std::string& name);

/// A file of a Trouble, mapped into memory.
class TroubleFile {
 public:
  explicit TroubleFile(const std::filesystem::path& file);
  TroubleFile(const TroubleFile&) = delete;
  TroubleFile& operator=(const TroubleFile&) = delete;
  ~TroubleFile();

  Trouble* operator->() const { return trouble_; }

 private:
  Trouble* trouble_ = nullptr;
};

/// A robot ('flinch serve') and who commands it ('flinch run'), each a program of its own, and a tap on their
/// bus. Both are preloaded with tests_bad_network.
class LinkTrial {
 public:
  /// A robot that the test has made itself, for a domain; a program of its own too.
  using OwnRobot = std::function<void(std::uint32_t domain)>;

  LinkTrial();
  explicit LinkTrial(OwnRobot robot);
  /// Robot and commander each in a network of its own, each with a tap.
  explicit LinkTrial(const TwoNetworks& networks);
  ~LinkTrial();

  void start_robot();
  void start_commander();
  /// A program that wants to command the same robot, with these arguments besides.
  std::unique_ptr<OtherProgram> other_commander(const std::vector<std::string>& arguments,
                                                const std::string& scenario = "scenarios/square.yaml") const;

  /// Starts both, and waits until the robot has been moving for 0.3 s. Begins anew, four times at most,
  /// where the machine is too busy for a run to get so far. Throws TooBusy where it never gets there.
  void get_moving();
  /// The same with another commander for the robot that is there.
  void get_moving_again();
  /// Waits until the brakes have been open for 0.3 s since the commander was started; false where they close
  /// before.
  bool wait_for_motion();

  OtherProgram& robot() { return *robot_; }
  OtherProgram& commander() { return *commander_; }
  const TroubleFile& trouble() const { return trouble_; }
  std::uint32_t domain() const { return domain_; }
  std::filesystem::path recording() const { return folder_ / "out" / "run.h5"; }

  /// What is on the bus where the robot is, and where the commander is.
  const BusLog& at_robot() const { return robots_tap_->log(); }
  const BusLog& at_commander() const { return commanders_tap_ ? commanders_tap_->log() : at_robot(); }

 private:
  LinkTrial(OwnRobot robot, const TwoNetworks* networks);
  std::vector<std::string> bus_arguments() const;
  void get_moving_with(bool new_robot);
  /// The flinch that is tested, in a network namespace or ours.
  std::unique_ptr<OtherProgram> start(const std::vector<std::string>& arguments,
                                      const std::string& network) const;

  TemporaryFolder folder_;
  OwnRobot own_robot_;
  const TwoNetworks* networks_;
  std::uint32_t domain_;
  TroubleFile trouble_;
  std::uint32_t status_before_ = 0;  ///< what the robot had sent when the commander was started
  std::unique_ptr<BusTap> robots_tap_;
  std::unique_ptr<BusTap> commanders_tap_;
  std::unique_ptr<OtherProgram> robot_;
  std::unique_ptr<OtherProgram> commander_;
};

}  // namespace flinch::test
