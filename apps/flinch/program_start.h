#pragma once

namespace flinch {

/// What a program does before anything else. Standard streams that are closed are opened, so that no file
/// takes their place: nothing comes in, messages go nowhere, and results fail. A reader of its output that is
/// gone and a file that would grow too large are errors of writing then, and not the end of the program.
void start_program() noexcept;

}  // namespace flinch
