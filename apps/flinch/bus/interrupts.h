#pragma once

namespace flinch {

/// Catches SIGINT (Ctrl-C) and SIGTERM while it lives, so that a program can end in order.
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
