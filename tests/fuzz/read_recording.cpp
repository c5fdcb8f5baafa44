#include "tests/fuzz/read_recording.h"

#include <algorithm>
#include <vector>

#include "systems/framework/recording.h"

namespace flinch::test {

void read_all_of(const Recording& recording) {
  std::vector<internal::Number> rows;
  for (const Signal& signal : recording.signals) {
    for (std::size_t first = 0; first < recording.samples(); first += Recording::block) {
      const std::size_t count = std::min(Recording::block, recording.samples() - first);
      rows.resize(count * signal.layout.numbers);
      recording.read_rows(signal, first, count, rows.data());
    }
    for (const Field& field : signal.layout.fields) {
      for (const int element : {0, field.capacity - 1, field.capacity, -1})
        recording.column(signal.path, field.name, element);
    }
  }
}

}  // namespace flinch::test
