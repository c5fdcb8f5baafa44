#pragma once

#include <list>

#include "tests/support/other_program.h"

namespace flinch::test {

/// Programs that do nothing but keep processors busy, while this lives.
class BusyLoops {
 public:
  explicit BusyLoops(int count) {
    for (int i = 0; i < count; ++i) {
      loops_.emplace_back(OtherProgram::Start{.command = {"/bin/sh", "-c", "while :; do :; done"},
                                              .environment = {},
                                              .preloaded = "",
                                              .prepare = {}});
    }
  }

 private:
  std::list<OtherProgram> loops_;
};

}  // namespace flinch::test
