#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <vector>

#include "systems/framework/recording.h"

namespace flinch {

/// What a reader looks at: field and signal, as far as recordings have it.
struct ChartedField {
  const char* signal;
  const char* field;
  const char* title;
};
std::span<const ChartedField> charted_fields();

/// The time axis of all charts: sample k is at start + k * period, and has the lowest or, where k is odd, the
/// highest value of its stretch.
struct ChartAxis {
  double start = 0.0;   ///< [s]
  double period = 0.0;  ///< [s]
  std::size_t count = 0;
  bool has_stretches = false;  ///< otherwise each sample of the fastest recording has its own
};
/// At most 4000 samples.
ChartAxis chart_axis(double first, double last, double period);

/// A component of a field on an axis; NaN where there is nothing, or where its signal says that it is not
/// known.
struct DrawnComponent {
  std::string field, name, unit;
  std::vector<double> values;
};

/// The charted fields of one signal on an axis, of a recording that comes whole or in parts.
class SignalDrawing {
 public:
  /// `delay`: by which it is drawn earlier [s]. `like`: another signal, whose charted fields are taken.
  SignalDrawing(std::string path, const ChartAxis& axis, double delay = 0.0, std::string like = "");

  void see(const Recording& part);
  std::vector<DrawnComponent> components() const;

 private:
  /// The lowest and the highest value of each stretch.
  struct Seen {
    std::string field, name, unit;
    std::vector<double> low, high;

    void hold(std::size_t at, double value);
  };

  std::size_t stride() const { return axis_.has_stretches ? 2 : 1; }
  Seen& seen(const std::string& field, const std::string& name, const std::string& unit);

  std::string path_;
  ChartAxis axis_;
  double delay_;
  std::string like_;
  std::vector<Seen> seen_;
};

/// A signal as one of a page's sources has it.
struct DrawnSignal {
  std::size_t run = 0;  ///< number of the source
  std::vector<DrawnComponent> components;
};
/// Appends to `charts`, a list, one for each component of a field, with a series for each source that has it.
void add_charts(const ChartedField& what, const std::vector<DrawnSignal>& drawn,
                nlohmann::ordered_json& charts);

/// Six digits, as a chart needs; null where there is no number.
nlohmann::ordered_json short_numbers(const std::vector<double>& values);

}  // namespace flinch
