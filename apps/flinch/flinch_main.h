#pragma once

#include <vector>

#include "systems/config/robot_kind.h"

namespace flinch {

/// The whole program `flinch`, with all its verbs, for `main` of a program of one's own: robot files may be
/// of `kinds` as well, in every verb that reads one. To be called once. Returns the exit status of the
/// program; problems, those of the kinds too, are printed.
///
///     int main(int argc, char** argv) { return flinch::flinch_main(argc, argv, {own_kind()}); }
int flinch_main(int argc, const char* const* argv, std::vector<RobotKind> kinds = {});

}  // namespace flinch
