#include "experiments/verdict/fault_words.h"

#include "systems/safety/fault_table.h"

namespace flinch {

std::string description_of(GateFault fault, const std::string& otherwise) {
  for (const FaultRow& row : fault_table()) {
    if (row.fault == fault) return row.description;
  }
  return otherwise;
}

}  // namespace flinch
