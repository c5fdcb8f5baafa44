// A secured bus between programs of their own: who takes part, and who does not.
#include "drivers/bus_security.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <ctime>
#include <iomanip>
#include <iostream>
#include <sstream>

#include "systems/foundation/setup_error.h"
#include "tests/drivers/intruder.h"
#include "tests/drivers/key_folder.h"
#include "tests/drivers/link_ends.h"
#include "tests/support/allocations.h"
#include "tests/support/free_domain.h"
#include "tests/support/other_program.h"
#include "tests/support/shared_memory.h"

namespace flinch {
namespace {

using test::FarEnd;
using test::Intrusion;
using test::KeyFolder;
using test::NearEnd;
using test::OtherProgram;
using test::SharedMemory;
using testing::Each;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

BusSettings settings(std::uint32_t domain, const KeyFolder& keys, BusRole role) {
  return {.domain = domain, .security = keys.of(role)};
}

TEST(BusSecurity, NamesEachFileThatIsMissingAndTheWayOut) {
  const BusSecurity security{.folder = "nowhere", .role = BusRole::robot};
  EXPECT_THAT(key_problems(security), SizeIs(6));
  EXPECT_THAT(key_problems(security), Each(HasSubstr("'flinch keys DIR'")));
  EXPECT_THAT(key_problems(security)[2], HasSubstr("nowhere/robot/certificate.pem"));
  EXPECT_THAT(problems(BusSettings{.security = security}), SizeIs(6));
  EXPECT_THAT(key_problems(BusSecurity{}), SizeIs(1));
  const KeyFolder keys;
  EXPECT_THAT(key_problems(keys.of(BusRole::robot)), IsEmpty());
}

TEST(BusSecurity, EndsTheWarningOfABusThatOthersCanReachUnlessTheyCanReadTheKey) {
  const KeyFolder keys;
  BusSettings settings{.interface = "eth0", .anyone_may_command = true};
  EXPECT_THAT(warnings(settings), SizeIs(1));
  settings.security = keys.of(BusRole::controller);
  EXPECT_THAT(warnings(settings), IsEmpty());
  std::filesystem::permissions(keys.file(BusRole::controller, security_file::private_key),
                               std::filesystem::perms::group_read, std::filesystem::perm_options::add);
  EXPECT_THAT(warnings(settings), testing::ElementsAre(HasSubstr("chmod 600")));
}

TEST(BusSecurity, WarnsOfAFolderWhereOthersMayPutTheirKeys) {
  const KeyFolder keys;
  const BusSecurity security = keys.of(BusRole::robot);
  EXPECT_THAT(key_warnings(security), IsEmpty());
  std::filesystem::permissions(security.folder, std::filesystem::perms::others_write,
                               std::filesystem::perm_options::add);
  EXPECT_THAT(key_warnings(security), testing::ElementsAre(HasSubstr("chmod go-w")));
}

TEST(BusSecurity, WarnsOfKeysThatEndSoon) {
  const KeyFolder short_ones({.days = 29}), long_ones({.days = 31});
  EXPECT_THAT(key_warnings(short_ones.of(BusRole::robot)),
              testing::ElementsAre(HasSubstr("these keys end at 20")));
  EXPECT_THAT(key_warnings(long_ones.of(BusRole::robot)), IsEmpty());
}

TEST(BusSecurity, TakesThePluginsFromWhereTheRunningLibraryIs) {
  for (const auto& [property, value] : participant_properties({.folder = "keys"})) {
    if (property.find("library.path") == std::string::npos) continue;
    EXPECT_TRUE(std::filesystem::path(value).is_absolute()) << value;
    EXPECT_TRUE(std::filesystem::is_regular_file(value)) << value;
  }
}

std::string refusal(const BusSettings& settings) {
  try {
    const DdsBus bus(settings);
  } catch (const SetupError& error) {
    return error.what();
  }
  return "";
}

TEST(BusSecurity, RefusesKeysThatDoNotFit) {
  const std::uint32_t domain = test::free_domain();
  const KeyFolder other_domain({.domains = {.first = domain + 1, .last = domain + 1}});
  EXPECT_THAT(refusal(settings(domain, other_domain, BusRole::robot)), HasSubstr("are refused"));

  const KeyFolder keys, others;
  EXPECT_EQ(refusal(settings(domain, keys, BusRole::observer)), "");
  const auto file = keys.file(BusRole::observer, security_file::permissions);
  const std::string own = test::bytes_of(file);
  test::overwrite(file, test::bytes_of(keys.file(BusRole::controller, security_file::permissions)));
  EXPECT_THAT(refusal(settings(domain, keys, BusRole::observer)), HasSubstr("are refused"))
      << "of another role";
  test::overwrite(file, test::bytes_of(others.file(BusRole::observer, security_file::permissions)));
  EXPECT_THAT(refusal(settings(domain, keys, BusRole::observer)), HasSubstr("are refused")) << "of others";
  std::string changed = own;
  changed.replace(changed.find("</allow_rule>"), 0,
                  "<publish><topics><topic>flinch/torque_command</topic></topics></publish>");
  test::overwrite(file, changed);
  EXPECT_THAT(refusal(settings(domain, keys, BusRole::observer)), HasSubstr("are refused")) << "changed";
}

// ---------------------------------------------------------------- with keys

TEST(SecuredPrograms, BringReadingsOneWayAndTorquesTheOther) {
  const std::uint32_t domain = test::free_domain();
  const KeyFolder keys;
  const OtherProgram robot([&] {
    const DdsBus bus(settings(domain, keys, BusRole::robot));
    FarEnd far(bus);
    far.run([] { return false; });
  });
  const DdsBus bus(settings(domain, keys, BusRole::controller));
  NearEnd near(bus);
  std::vector<double> round_trips;  // [us]
  std::int64_t most_allocations = 0, before = -1;
  Time matched{};
  near.run([&] {
    const std::int64_t now = test::allocations();
    if (before >= 0) most_allocations = std::max(most_allocations, now - before);
    const DdsLink link = near.dds().link();
    if (link.commands_obeyed) round_trips.push_back(1e6 * to_seconds(link.round_trip));
    if (round_trips.size() == 1) matched = near.time(), round_trips.reserve(3000);
    before = test::allocations();
    return round_trips.size() == 3000 || near.time() > 60s;
  });
  ASSERT_EQ(round_trips.size(), 3000u);
  std::sort(round_trips.begin(), round_trips.end());
  std::cout << "round trip [us]: p50 " << round_trips[1500] << ", p99 " << round_trips[2970] << ", p99.9 "
            << round_trips[2997] << ", most " << round_trips.back() << "; obeyed after "
            << 1e3 * to_seconds(matched) << " ms" << std::endl;
  EXPECT_EQ(most_allocations, 0);
}

/// Seconds of the wall clock as permissions have it.
std::string date(std::time_t time) {
  std::ostringstream text;
  text << std::put_time(std::gmtime(&time), "%Y-%m-%dT%H:%M:%SZ");
  return text.str();
}

TEST(SecuredPrograms, EndTheLinkWhenThePermissionsDo) {
  const std::uint32_t domain = test::free_domain();
  const KeyFolder keys;
  const std::time_t end = std::time(nullptr) + 3;
  test::sign_anew(keys, [end](std::string&, std::string& permissions) {
    const std::string tag = "<not_after>";
    permissions.replace(permissions.find(tag) + tag.size(), date(end).size(), date(end));
  });
  const OtherProgram controller([&] {
    const DdsBus bus(settings(domain, keys, BusRole::controller));
    NearEnd near(bus);
    near.run([] { return false; });
  });
  const DdsBus bus(settings(domain, keys, BusRole::robot));
  FarEnd far(bus);
  int obeyed = 0, ticks = 0;
  far.run([&] {
    obeyed += far.brake() ? 0 : 1;
    return (obeyed > 100 && far.brake() && std::time(nullptr) >= end) || ++ticks > 10000;
  });
  EXPECT_GT(obeyed, 100);
  EXPECT_TRUE(far.brake());
  EXPECT_LE(std::time(nullptr), end + 1);
}

// ---------------------------------------------------------------- without, or with others

/// What the robot saw of an intruder, alone with it and beside its controller.
struct Seen {
  std::uint32_t received_alone = 0;  ///< torque commands, admitted or not
  bool braked_alone = true;
  int obeyed = 0;    ///< ticks under the controller
  int intruded = 0;  ///< ticks with the intruder's torque
};

/// Has the robot, for a while with the intruder only and then beside its controller, which `go` lets begin,
/// until the intruder has seen some commands.
Seen watch(const BusSettings& settings, std::atomic<bool>& go, Intrusion& intrusion,
           std::uint32_t commands_to_see = 0) {
  const DdsBus bus(settings);
  FarEnd far(bus);
  intrusion.robot_id = far.server().robot_id();
  Seen seen;
  const auto count = [&] {
    const TorqueCommand& torque = far.torque();
    if (!torque.valid) return;
    ++(torque.torque[0] == test::intruders_torque ? seen.intruded : seen.obeyed);
  };
  int alone = 0;
  far.run([&] {
    count();
    seen.braked_alone = seen.braked_alone && far.brake();
    return ++alone > 1500 && (intrusion.sent > 300 || alone > 3000);
  });
  seen.received_alone = far.server().commander().received + far.server().commander().refused;
  go = true;
  int together = 0;
  far.run([&] {
    count();
    return (seen.obeyed >= 1000 && intrusion.commands_seen >= commands_to_see) || ++together > 10000;
  });
  return seen;
}

/// The programs besides the robot: an intruder, and a controller that waits for a sign.
struct Others {
  Others(const BusSettings& intruders, const BusSettings& controllers, const std::string& access_control = "")
      : intruder([&] { test::intrude(intruders, access_control, *intrusion); }), controller([&] {
          while (!*go) MonotonicClock::sleep_until(MonotonicClock::now() + 1ms);
          const DdsBus bus(controllers);
          NearEnd near(bus);
          near.run([] { return false; });
        }) {}

  SharedMemory<Intrusion> intrusion;
  SharedMemory<std::atomic<bool>> go;
  OtherProgram intruder;
  OtherProgram controller;
};

void print(const char* who, const Intrusion& intrusion, const Seen& seen) {
  std::cout << who << ": sent " << intrusion.sent << " torque commands, " << seen.received_alone
            << " arrived, " << seen.intruded << " ticks obeyed; saw " << intrusion.readings_seen
            << " joint samples and " << intrusion.commands_seen
            << " torque commands; the controller was obeyed " << seen.obeyed << " ticks" << std::endl;
}

void expect_no_effect(const Seen& seen) {
  EXPECT_EQ(seen.received_alone, 0u);
  EXPECT_TRUE(seen.braked_alone);
  EXPECT_EQ(seen.intruded, 0);
  EXPECT_GE(seen.obeyed, 1000);
}

TEST(Intruder, CommandsARobotOnABusWithoutSecurity) {
  const std::uint32_t domain = test::free_domain();
  Others others({.domain = domain}, {.domain = domain});
  const DdsBus bus({.domain = domain});
  FarEnd far(bus);
  others.intrusion->robot_id = far.server().robot_id();
  int intruded = 0, ticks = 0;
  far.run([&] {
    intruded += far.torque().valid && far.torque().torque[0] == test::intruders_torque ? 1 : 0;
    return intruded == 300 || ++ticks == 10000;
  });
  EXPECT_EQ(intruded, 300);
  EXPECT_GT(others.intrusion->readings_seen, 0u);
  EXPECT_TRUE(others.intrusion->is_heard);
}

TEST(Intruder, WithoutKeysNeitherCommandsNorListens) {
  const std::uint32_t domain = test::free_domain();
  const KeyFolder keys;
  Others others({.domain = domain}, settings(domain, keys, BusRole::controller));
  const Seen seen = watch(settings(domain, keys, BusRole::robot), *others.go, *others.intrusion);
  print("without keys", *others.intrusion, seen);
  expect_no_effect(seen);
  EXPECT_GT(others.intrusion->sent, 1000u);
  EXPECT_EQ(others.intrusion->readings_seen, 0u);
  EXPECT_EQ(others.intrusion->commands_seen, 0u);
  EXPECT_FALSE(others.intrusion->is_heard);
}

TEST(Intruder, WithAControllersKeysFromElsewhereNeitherCommandsNorListens) {
  const std::uint32_t domain = test::free_domain();
  const KeyFolder keys, rogue;
  Others others(settings(domain, rogue, BusRole::controller), settings(domain, keys, BusRole::controller));
  const Seen seen = watch(settings(domain, keys, BusRole::robot), *others.go, *others.intrusion);
  print("keys from elsewhere", *others.intrusion, seen);
  expect_no_effect(seen);
  EXPECT_GT(others.intrusion->sent, 1000u);
  EXPECT_EQ(others.intrusion->readings_seen, 0u);
  EXPECT_EQ(others.intrusion->commands_seen, 0u);
  EXPECT_FALSE(others.intrusion->is_heard);
}

TEST(Intruder, WithAnObserversKeysListensButCannotMakeAWriter) {
  const std::uint32_t domain = test::free_domain();
  const KeyFolder keys;
  Others others(settings(domain, keys, BusRole::observer), settings(domain, keys, BusRole::controller));
  const Seen seen = watch(settings(domain, keys, BusRole::robot), *others.go, *others.intrusion, 100);
  print("observer", *others.intrusion, seen);
  expect_no_effect(seen);
  EXPECT_TRUE(others.intrusion->is_on_bus);
  EXPECT_FALSE(others.intrusion->has_writer);
  EXPECT_GT(others.intrusion->readings_seen, 1000u);
  EXPECT_GE(others.intrusion->commands_seen, 100u);
}

TEST(Intruder, WithAnObserversKeysAndWithoutItsOwnCheckIsNotHeard) {
  const std::uint32_t domain = test::free_domain();
  const KeyFolder keys;
  Others others(settings(domain, keys, BusRole::observer), settings(domain, keys, BusRole::controller),
                LENIENT_ACCESS_CONTROL);
  const Seen seen = watch(settings(domain, keys, BusRole::robot), *others.go, *others.intrusion);
  print("observer, patched", *others.intrusion, seen);
  expect_no_effect(seen);
  EXPECT_TRUE(others.intrusion->has_writer);
  EXPECT_GT(others.intrusion->sent, 1000u);
  EXPECT_GT(others.intrusion->readings_seen, 1000u);
  EXPECT_FALSE(others.intrusion->is_heard);
}

}  // namespace
}  // namespace flinch
