#pragma once

#include <signal.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <functional>
#include <new>

namespace flinch::test {

/// A program of its own, until killed. Made before this one is on any bus: threads do not survive a fork.
class OtherProgram {
 public:
  explicit OtherProgram(const std::function<void()>& body) : id_(::fork()) {
    if (id_ != 0) return;
    body();
    ::_exit(0);
  }
  OtherProgram(const OtherProgram&) = delete;
  OtherProgram& operator=(const OtherProgram&) = delete;
  ~OtherProgram() {
    if (id_ > 0) kill(), ::waitpid(id_, nullptr, 0);
  }

  void kill() { ::kill(id_, SIGKILL); }
  void stop() { ::kill(id_, SIGSTOP); }
  void resume() { ::kill(id_, SIGCONT); }

 private:
  pid_t id_;
};

/// A value that this program shares with those it makes later; of atomics.
template <class T>
class SharedMemory {
 public:
  SharedMemory() {
    void* const memory =
        ::mmap(nullptr, sizeof(T), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    if (memory == MAP_FAILED) throw std::bad_alloc();
    value_ = new (memory) T();
  }
  SharedMemory(const SharedMemory&) = delete;
  SharedMemory& operator=(const SharedMemory&) = delete;
  ~SharedMemory() { ::munmap(value_, sizeof(T)); }

  T* operator->() const { return value_; }
  T& operator*() const { return *value_; }

 private:
  T* value_;
};

}  // namespace flinch::test
