#include "systems/framework/realtime_thread.h"

#include <gtest/gtest.h>
#include <linux/capability.h>
#include <pthread.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "systems/foundation/setup_error.h"
#include "tests/support/sanitized.h"

namespace flinch {
namespace {

RealtimeSettings nothing() {
  RealtimeSettings settings;
  settings.scheduling = Requirement::none;
  settings.locked_memory = Requirement::none;
  settings.affinity = Requirement::none;
  settings.realtime_kernel = Requirement::none;
  return settings;
}

/// The policy and priority of this thread, as the system tells.
std::pair<int, int> scheduling() {
  int policy = 0;
  sched_param parameters{};
  pthread_getschedparam(pthread_self(), &policy, &parameters);
  return {policy, parameters.sched_priority};
}

int processors() {
  cpu_set_t set;
  pthread_getaffinity_np(pthread_self(), sizeof set, &set);
  return CPU_COUNT(&set);
}

/// One processor that this thread may use.
int some_processor() {
  cpu_set_t set;
  pthread_getaffinity_np(pthread_self(), sizeof set, &set);
  int cpu = 0;
  while (!CPU_ISSET(static_cast<std::size_t>(cpu), &set)) ++cpu;
  return cpu;
}

TEST(RealtimeThread, ReportsNothingWhenNothingIsAskedFor) {
  const auto before = scheduling();
  const RealtimeThread thread(nothing());
  EXPECT_TRUE(thread.report().privileges.empty());
  EXPECT_TRUE(thread.report().all_granted());
  EXPECT_EQ(scheduling(), before);
}

TEST(RealtimeThread, ReportsOfThePriorityWhatTheSystemSaysAndGivesItBack) {
  const auto before = scheduling();
  RealtimeSettings settings = nothing();
  settings.scheduling = Requirement::prefer;
  settings.priority = 3;
  {
    const RealtimeThread thread(settings);
    ASSERT_EQ(thread.report().privileges.size(), 1U);
    const Privilege& privilege = thread.report().privileges[0];
    EXPECT_EQ(privilege.name, "SCHED_FIFO priority 3");
    EXPECT_EQ(privilege.granted, scheduling() == std::pair(SCHED_FIFO, 3));
    EXPECT_EQ(privilege.granted, privilege.reason.empty());
  }
  EXPECT_EQ(scheduling(), before);
}

TEST(RealtimeThread, RunsOnTheProcessorAskedForAndGivesItBack) {
  const int before = processors();
  RealtimeSettings settings = nothing();
  settings.affinity = Requirement::require;
  settings.cpu = some_processor();
  {
    const RealtimeThread thread(settings);
    EXPECT_TRUE(thread.report().all_granted());
    EXPECT_EQ(processors(), 1);
    EXPECT_EQ(sched_getcpu(), settings.cpu);
  }
  EXPECT_EQ(processors(), before);
}

TEST(RealtimeThread, DoesNotStartWithoutWhatIsRequiredAndSaysAllThatIsMissing) {
  const auto before = scheduling();
  RealtimeSettings settings = nothing();
  settings.scheduling = Requirement::require;
  settings.priority = 100;
  settings.affinity = Requirement::require;
  settings.cpu = 1'000'000;
  try {
    const RealtimeThread thread(settings);
    FAIL();
  } catch (const SetupError& error) {
    ASSERT_EQ(error.problems().size(), 2U);
    EXPECT_EQ(error.problems()[0],
              "SCHED_FIFO priority 100 was not granted: Invalid argument; choose a priority from 1 to 99");
    EXPECT_NE(error.problems()[1].find("processor 1000000 was not granted"), std::string::npos);
  }
  EXPECT_EQ(scheduling(), before);
}

TEST(RealtimeThread, StartsWithoutWhatIsOnlyPreferredAndSaysSo) {
  RealtimeSettings settings = nothing();
  settings.affinity = Requirement::prefer;
  settings.cpu = -1;
  const RealtimeThread thread(settings);
  EXPECT_FALSE(thread.report().all_granted());
  EXPECT_NE(thread.report().text().find("processor -1 was not granted: Invalid argument"), std::string::npos);
}

/// Gives up, for good, whatever may permit real time: as if an ordinary user had started the program.
void give_up_privileges() {
  const rlimit none{0, 0};
  setrlimit(RLIMIT_RTPRIO, &none);
  setrlimit(RLIMIT_MEMLOCK, &none);
  __user_cap_header_struct this_process{_LINUX_CAPABILITY_VERSION_3, 0};
  const __user_cap_data_struct no_capabilities[2]{};
  syscall(SYS_capset, &this_process, no_capabilities);
}

bool mentions(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST(RealtimeThreadDeathTest, TellsAnOrdinaryUserHowToPermitIt) {
  const auto ask_as_ordinary_user = [] {
    give_up_privileges();
    RealtimeSettings settings = nothing();
    settings.scheduling = Requirement::prefer;
    settings.priority = 42;
    settings.locked_memory = Requirement::prefer;
    const RealtimeThread thread(settings);
    const std::string text = thread.report().text();
    const bool told = mentions(text, "SCHED_FIFO priority 42 was not granted: Operation not permitted") &&
                      mentions(text, "* - rtprio 42") && mentions(text, "setcap cap_sys_nice") &&
                      mentions(text, "ulimit -r") &&
                      (test::sanitized() || mentions(text, "locked memory was not granted"));
    std::_Exit(told ? 0 : 1);
  };
  EXPECT_EXIT(ask_as_ordinary_user(), testing::ExitedWithCode(0), "");
}

/// How much memory of this process is locked, as the system tells [KiB].
int locked_memory() {
  std::ifstream status("/proc/self/status");
  std::string word;
  int kib = 0;
  while (status >> word && word != "VmLck:") continue;
  status >> kib;
  return kib;
}

TEST(RealtimeThread, ReportsOfLockedMemoryWhatTheSystemSays) {
  RealtimeSettings settings = nothing();
  settings.locked_memory = Requirement::prefer;
  const RealtimeThread thread(settings);
  ASSERT_EQ(thread.report().privileges.size(), 1U);
  if (test::sanitized()) GTEST_SKIP() << "sanitizers do not let memory be locked";
  EXPECT_EQ(thread.report().privileges[0].granted, locked_memory() > 0);
}

TEST(RealtimeThread, LooksForARealtimeKernel) {
  RealtimeSettings settings = nothing();
  settings.realtime_kernel = Requirement::prefer;
  const RealtimeThread thread(settings);
  ASSERT_EQ(thread.report().privileges.size(), 1U);
  const Privilege& privilege = thread.report().privileges[0];
  EXPECT_EQ(privilege.granted, std::filesystem::exists("/sys/kernel/realtime"));
  EXPECT_EQ(privilege.granted, privilege.remedy.empty());
}

}  // namespace
}  // namespace flinch
