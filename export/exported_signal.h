#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "systems/framework/recording.h"

namespace flinch {

/// A field of a recorded signal as other tools get it: as wide as it ever was, its numbers with names.
struct ExportedField {
  std::string name;  ///< "wrench_in_base"
  Field::Kind kind{};
  std::string frame;
  std::size_t first = 0;  ///< number of a row at which its numbers begin
  bool resizable = false;
  std::vector<std::string> components;  ///< "fx", "fy", "mz"; of a single number one that is ""
  std::vector<std::string> units;       ///< of each; "" for none

  std::size_t width() const { return components.size(); }
  /// "wrench_in_base_fx"
  std::string column(std::size_t component) const;
  /// How many of its numbers a row has.
  std::size_t numbers_in(const internal::Number* row) const;
};

/// A recorded signal likewise.
struct ExportedSignal {
  std::string path;
  const Signal* signal = nullptr;     ///< of the recording, which must outlive this
  std::vector<ExportedField> fields;  ///< those that ever hold a number
  std::vector<std::string> left_out;  ///< names of the others
};

/// The signals called `names`, all for none. Reads sizes that may change in every sample. Throws SetupError
/// with the nearest name for one that the recording does not have.
std::vector<ExportedSignal> exported_signals(const Recording& recording,
                                             const std::vector<std::string>& names);

/// Told of a block of rows: the number of the first sample, how many there are, and the rows.
using TakeRows = std::function<void(std::size_t first, std::size_t count, const internal::Number* rows)>;

/// Reads a signal block by block.
void for_each_block(const Recording& recording, const Signal& signal, const TakeRows& take);

/// What a tool needs to know of signals besides numbers, as one JSON object: by signal and field components,
/// units and frame.
std::string description_json(const Recording& recording, const std::vector<ExportedSignal>& signals);

}  // namespace flinch
