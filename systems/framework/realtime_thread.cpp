#include "systems/framework/realtime_thread.h"

#include <pthread.h>
#include <sys/mman.h>

#include <cerrno>
#include <cstddef>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "systems/foundation/setup_error.h"

namespace flinch {
namespace {

constexpr std::size_t stack_to_touch = 256 * 1024;

/// The program's file, for commands to copy; words in its place where the system does not tell.
std::string program() {
  std::error_code error;
  const std::string file = std::filesystem::read_symlink("/proc/self/exe", error).string();
  return error ? "PROGRAM" : file;
}

std::string permit(const std::string& limit, const std::string& value, const std::string& option) {
  return "for all users, put the line '* - " + limit + " " + value +
         "' into /etc/security/limits.d/flinch.conf and log in again ('ulimit " + option +
         "' shows the limit); for this program, run 'sudo setcap cap_sys_nice,cap_ipc_lock=ep " + program() +
         "'; for a container, add --cap-add=sys_nice --cap-add=ipc_lock to its start";
}

/// The answer to a request that returned `error` (0: granted).
Privilege answer(std::string name, Requirement insistence, int error, std::string remedy) {
  if (error == 0) return {std::move(name), insistence, true, "", ""};
  return {std::move(name), insistence, false, std::strerror(error), std::move(remedy)};
}

Privilege ask_for_priority(Requirement insistence, int priority) {
  sched_param parameters{};
  parameters.sched_priority = priority;
  const int error = pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameters);
  const std::string number = std::to_string(priority);
  return answer("SCHED_FIFO priority " + number, insistence, error,
                error == EINVAL ? "choose a priority from 1 to 99" : permit("rtprio", number, "-r"));
}

/// Lets the stack grow now, so that its pages are there to be locked.
void touch_stack() {
  [[maybe_unused]] volatile std::byte stack[stack_to_touch];
  for (std::size_t i = 0; i < stack_to_touch; i += 1024) stack[i] = std::byte{0};
}

Privilege ask_for_locked_memory(Requirement insistence) {
  touch_stack();
  const int error = mlockall(MCL_CURRENT) == 0 ? 0 : errno;
  return answer("locked memory", insistence, error, permit("memlock", "unlimited", "-l"));
}

Privilege ask_for_processor(Requirement insistence, int cpu) {
  cpu_set_t wanted;
  CPU_ZERO(&wanted);
  const bool exists = cpu >= 0 && cpu < CPU_SETSIZE;
  if (exists) CPU_SET(static_cast<std::size_t>(cpu), &wanted);
  const int error = exists ? pthread_setaffinity_np(pthread_self(), sizeof wanted, &wanted) : EINVAL;
  return answer(
      "processor " + std::to_string(cpu), insistence, error,
      "choose one that 'taskset -cp $$' lists: the others do not exist or are not for this process");
}

Privilege look_for_realtime_kernel(Requirement insistence) {
  std::ifstream file("/sys/kernel/realtime");
  int realtime = 0;
  file >> realtime;
  if (realtime == 1) return {"real-time kernel", insistence, true, "", ""};
  return {"real-time kernel", insistence, false,
          "this kernel was built without PREEMPT_RT: it may delay any thread for as long as a driver likes",
          "on Debian, 'apt install linux-image-rt-amd64', and start that kernel"};
}

std::string problem(const Privilege& privilege) {
  return privilege.name + " was not granted: " + privilege.reason + "; " + privilege.remedy;
}

std::vector<std::string> refused_requirements(const std::vector<Privilege>& privileges) {
  std::vector<std::string> problems;
  for (const Privilege& privilege : privileges) {
    const bool required = privilege.insistence == Requirement::require;
    if (required && !privilege.granted) problems.push_back(problem(privilege));
  }
  return problems;
}

}  // namespace

bool RealtimeReport::all_granted() const {
  for (const Privilege& privilege : privileges) {
    if (!privilege.granted) return false;
  }
  return true;
}

std::string RealtimeReport::text() const {
  std::string text;
  for (const Privilege& privilege : privileges) {
    text += privilege.granted ? privilege.name + ": granted\n" : problem(privilege) + "\n";
  }
  return text;
}

bool permits_realtime(int priority) {
  int policy = 0;
  sched_param before{};
  pthread_getschedparam(pthread_self(), &policy, &before);
  const bool granted = ask_for_priority(Requirement::prefer, priority).granted;
  pthread_setschedparam(pthread_self(), policy, &before);
  return granted;
}

RealtimeThread::RealtimeThread(const RealtimeSettings& settings) {
  pthread_getschedparam(pthread_self(), &policy_, &parameters_);
  pthread_getaffinity_np(pthread_self(), sizeof processors_, &processors_);

  std::vector<Privilege>& privileges = report_.privileges;
  if (settings.scheduling != Requirement::none) {
    privileges.push_back(ask_for_priority(settings.scheduling, settings.priority));
  }
  if (settings.locked_memory != Requirement::none) {
    privileges.push_back(ask_for_locked_memory(settings.locked_memory));
  }
  if (settings.affinity != Requirement::none) {
    privileges.push_back(ask_for_processor(settings.affinity, settings.cpu));
  }
  if (settings.realtime_kernel != Requirement::none) {
    privileges.push_back(look_for_realtime_kernel(settings.realtime_kernel));
  }

  std::vector<std::string> problems = refused_requirements(privileges);
  if (!problems.empty()) give_back();
  throw_if_any(std::move(problems));
}

RealtimeThread::~RealtimeThread() { give_back(); }

void RealtimeThread::give_back() {
  pthread_setschedparam(pthread_self(), policy_, &parameters_);
  pthread_setaffinity_np(pthread_self(), sizeof processors_, &processors_);
}

}  // namespace flinch
