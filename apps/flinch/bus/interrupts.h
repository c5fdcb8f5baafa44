#pragma once

namespace flinch {

/// Catches SIGINT (Ctrl-C), SIGTERM and SIGHUP (its terminal is gone) while it lives, so that a program can
/// end in order; nor does it die of a pipe that nobody reads.
class Interrupts {
 public:
  Interrupts();
  ~Interrupts();
  Interrupts(const Interrupts&) = delete;
  Interrupts& operator=(const Interrupts&) = delete;

  /// How many have come.
  static int count() noexcept;
};

}  // namespace flinch
