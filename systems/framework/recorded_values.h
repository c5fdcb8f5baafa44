#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

#include "systems/foundation/setup_error.h"
#include "systems/framework/recording.h"

namespace flinch {

/// The recorded values of one port, as T, bit for bit: values[k] is that of sample k. Of a recording in a
/// file one block of samples is in memory at a time, so read them in their order; one object serves one
/// thread.
template <Recordable T>
class RecordedValues {
 public:
  /// Throws SetupError when the recording has no signal `path` or its fields are not those of T. The
  /// recording must outlive the values.
  RecordedValues(const Recording& recording, const std::string& path)
      : recording_(&recording), signal_(&recording.signal(path)) {
    const RowLayout expected = row_layout<T>();
    const std::vector<Field>& fields = signal_->layout.fields;
    const auto same = [](const Field& a, const Field& b) {
      return a.name == b.name && a.kind == b.kind && a.capacity == b.capacity && a.resizable == b.resizable;
    };
    if (!std::equal(expected.fields.begin(), expected.fields.end(), fields.begin(), fields.end(), same)) {
      throw SetupError("the signal '" + path +
                       "' was recorded with other fields than this version of flinch has");
    }
  }

  std::size_t size() const { return recording_->samples(); }

  /// Throws SetupError where the sample cannot be read or has a matrix of impossible size.
  T operator[](std::size_t sample) const {
    if (sample < first_ || sample >= first_ + count_) load(sample);
    T value{};
    if (!read_row(rows_.data() + (sample - first_) * signal_->layout.numbers, value)) {
      throw SetupError("the signal '" + signal_->path +
                       "' has a sample with an impossible size; the recording is broken");
    }
    return value;
  }

 private:
  void load(std::size_t sample) const {
    first_ = sample / Recording::block * Recording::block;
    count_ = std::min(Recording::block, size() - first_);
    rows_.resize(count_ * signal_->layout.numbers);
    recording_->read_rows(*signal_, first_, count_, rows_.data());
  }

  const Recording* recording_;
  const Signal* signal_;
  mutable std::vector<internal::Number> rows_;  ///< of the samples first_ ... first_ + count_
  mutable std::size_t first_ = 0;
  mutable std::size_t count_ = 0;
};

/// The values of the port `path`: read<PlatformMotion>(recording, "motion")[k].pose
template <Recordable T>
RecordedValues<T> read(const Recording& recording, const std::string& path) {
  return RecordedValues<T>(recording, path);
}

}  // namespace flinch
