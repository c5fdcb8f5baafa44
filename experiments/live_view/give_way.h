#pragma once

namespace flinch {

/// Lets other threads that want the processor go before the calling one and those that it starts: who runs
/// an experiment goes before who shows it.
void give_way() noexcept;

}  // namespace flinch
