#include "tests/fuzz/read_recording.h"

#include "systems/framework/recording_file.h"

namespace flinch::test {

void read_all_of(const Recording& recording) {
  read_every_row(recording);
  for (const Signal& signal : recording.signals) {
    for (const Field& field : signal.layout.fields) {
      for (const int element : {0, field.capacity - 1, field.capacity, -1})
        recording.column(signal.path, field.name, element);
    }
  }
}

}  // namespace flinch::test
