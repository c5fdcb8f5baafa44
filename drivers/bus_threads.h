#pragma once

#include <set>

#include <sys/types.h>

namespace flinch {

/// The threads of this program, by their numbers in the kernel.
std::set<pid_t> threads_of_program();

/// Lets every thread that is not among `before` run with SCHED_FIFO and `priority`. Throws SetupError where
/// that is not permitted.
void make_urgent_since(const std::set<pid_t>& before, int priority);

}  // namespace flinch
