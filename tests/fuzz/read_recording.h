#pragma once

namespace flinch {
struct Recording;
}

namespace flinch::test {

/// Reads all that there is, in each way that there is.
void read_all_of(const Recording& recording);

}  // namespace flinch::test
