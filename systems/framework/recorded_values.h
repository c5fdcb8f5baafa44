#pragma once

#include <algorithm>
#include <cstddef>
#include <string>
#include <vector>

#include "systems/foundation/nearest_name.h"
#include "systems/foundation/setup_error.h"
#include "systems/framework/recording.h"

namespace flinch {

/// The recorded values of one port, as T, bit for bit: values[k] is that of sample k. T is the type of the
/// port, or one with some of its fields; where their size can change, T may have more or less room for it. Of
/// a recording in a file one block of samples is in memory at a time, so read them in their order; one object
/// serves one thread.
template <Recordable T>
class RecordedValues {
 public:
  /// Throws SetupError when the recording has no signal `path`, or that has not all fields of T. The
  /// recording must outlive the values.
  RecordedValues(const Recording& recording, const std::string& path)
      : recording_(&recording), signal_(&recording.signal(path)) {
    std::size_t to = 0;
    for (const Field& field : row_layout<T>().fields) {
      pieces_.push_back(piece_of(field, to));
      to += numbers_of(field);
    }
    row_.resize(to);
  }

  std::size_t size() const { return recording_->samples(); }

  /// Throws SetupError where the sample cannot be read or has a matrix of impossible size.
  T operator[](std::size_t sample) const {
    const internal::Number* const recorded = recorded_row(sample);
    for (const Piece& piece : pieces_)
      std::copy_n(recorded + piece.from, piece.numbers, row_.data() + piece.to);
    T value{};
    if (!read_row(row_.data(), value)) {
      throw SetupError("the signal '" + signal_->path +
                       "' has a sample with an impossible size; the recording is broken");
    }
    return value;
  }

 private:
  /// Where the numbers of a field of T lie: in a recorded row, and in a row of T.
  struct Piece {
    std::size_t from;
    std::size_t to;
    std::size_t numbers;
  };

  static std::size_t numbers_of(const Field& field) {
    return static_cast<std::size_t>(field.capacity) + (field.resizable ? 2U : 0U);
  }

  /// Where `wanted` was recorded.
  Piece piece_of(const Field& wanted, std::size_t to) const {
    std::size_t from = 0;
    std::vector<std::string> names;
    for (const Field& field : signal_->layout.fields) {
      if (field.name != wanted.name) {
        names.push_back(field.name);
        from += numbers_of(field);
        continue;
      }
      const bool fits = field.resizable || field.capacity == wanted.capacity;
      if (field.kind == wanted.kind && field.resizable == wanted.resizable && fits) {
        return {from, to, std::min(numbers_of(field), numbers_of(wanted))};
      }
      throw SetupError("the field '" + wanted.name + "' of the signal '" + signal_->path +
                       "' was recorded with another type than this version of flinch has");
    }
    throw SetupError("the signal '" + signal_->path + "' was recorded without the field '" + wanted.name +
                     "'" + did_you_mean(wanted.name, names));
  }

  /// Where it lies in memory; a block of those that lie in a file is fetched.
  const internal::Number* recorded_row(std::size_t sample) const {
    if (!signal_->rows.empty()) return signal_->rows.data() + sample * signal_->layout.numbers;
    if (sample < first_ || sample >= first_ + count_) load(sample);
    return rows_->data() + (sample - first_) * signal_->layout.numbers;
  }

  void load(std::size_t sample) const {
    const std::size_t first = sample / Recording::block * Recording::block;
    const std::size_t count = std::min(Recording::block, size() - first);
    count_ = 0;  // until they are there
    rows_.reset();
    rows_ = recording_->shared_rows(*signal_, first, count);
    first_ = first;
    count_ = count;
  }

  const Recording* recording_;
  const Signal* signal_;
  std::vector<Piece> pieces_;
  mutable std::vector<internal::Number> row_;            ///< of T
  mutable std::shared_ptr<const RowSource::Rows> rows_;  ///< recorded: samples first_ ... first_ + count_
  mutable std::size_t first_ = 0;
  mutable std::size_t count_ = 0;
};

/// The values of the port `path`: read<PlatformMotion>(recording, "motion")[k].pose
template <Recordable T>
RecordedValues<T> read(const Recording& recording, const std::string& path) {
  return RecordedValues<T>(recording, path);
}

}  // namespace flinch
