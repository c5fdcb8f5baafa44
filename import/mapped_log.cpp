#include "import/mapped_log.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <set>

#include "import/log_candidate.h"
#include "systems/foundation/quantity_text.h"
#include "systems/foundation/setup_error.h"
#include "systems/robot/parallel_robot.h"

namespace flinch {
namespace {

constexpr double most_gaps = 100'000.0;  // periods without a row, of the smallest log

std::string rounded(double value) {
  std::string text = std::to_string(value);
  return text.substr(0, text.find('.') + 4);
}

/// The numbers of rows that are kept, in the memory of all.
std::vector<double> kept_values(std::vector<double> values, const std::vector<bool>& kept) {
  std::size_t count = 0;
  for (std::size_t k = 0; k < values.size(); ++k) {
    if (kept[k]) values[count++] = values[k];
  }
  values.resize(count);
  return values;
}

/// Two columns with the same numbers, or one that nothing is in.
std::string spread_of(const std::vector<double>& values) {
  double least = INFINITY, most = -INFINITY;
  for (const double value : values) {
    if (!std::isfinite(value)) continue;
    least = std::min(least, value);
    most = std::max(most, value);
  }
  return least > most ? "" : rounded(least) + " ... " + rounded(most);
}

/// Why a column may have no times, as the end of a sentence; "": nothing tells.
std::string told_of_clock(LogFile& file, std::size_t column, ClockUnit unit) {
  const std::vector<double> numbers = file.read(std::span(&column, 1)).front();
  const auto is_any = [&](const auto& is) { return std::any_of(numbers.begin(), numbers.end(), is); };
  if (!is_any([](double value) { return std::isfinite(value); })) return "; it holds no numbers";
  if (!is_any([unit](double value) { return instant_of(value, unit) != no_instant; }))
    return "; its numbers are too large for its unit: check 'unit' of 'time'";
  const bool is_single = !is_any([](double value) {
    return std::isfinite(value) && value != static_cast<double>(static_cast<float>(value));
  });
  const bool is_large = is_any([](double value) { return std::abs(value) > 1e6; });
  if (is_single && is_large)
    return "; its numbers have single precision, which tells times so large apart by " +
           std::to_string(std::lround(std::nextafter(static_cast<float>(numbers.front()), INFINITY) -
                                      static_cast<float>(numbers.front()))) +
           " only: log it with 64 bits, or map another column";
  return "";
}

}  // namespace

MappedLog::MappedLog(const LogMapping& mapping) : mapping_(mapping) {
  const std::unique_ptr<LogFile> file = open_log(mapping_.log);
  read(*file);
  place_samples();
  tell(*file);
  find_computed(*file);
}

/// A clock by itself, or that of the same name in the group of the columns that it is asked for.
std::vector<std::int64_t> MappedLog::instants_of(LogFile& file, const LogClock& clock,
                                                 const std::string& table) {
  const auto in_table = [&](const std::string& name) {
    const std::size_t column = file.find(name);
    if (file.columns()[column].table == table) return column;
    const std::string leaf = file.columns()[column].name.substr(file.columns()[column].name.rfind('/') + 1);
    for (std::size_t i = 0; i < file.columns().size(); ++i) {
      const LogColumn& other = file.columns()[i];
      if (other.table == table && other.name.substr(other.name.rfind('/') + 1) == leaf) return i;
    }
    return column;
  };
  std::vector<std::int64_t> instants = file.read_instants(in_table(clock.column), clock.unit);
  if (clock.second_column.empty()) return instants;
  const std::vector<std::int64_t> second =
      file.read_instants(in_table(clock.second_column), clock.second_unit);
  for (std::size_t k = 0; k < instants.size(); ++k) {
    const bool whole = k < second.size() && instants[k] != no_instant && second[k] != no_instant;
    instants[k] = whole ? instants[k] + second[k] : no_instant;
  }
  return instants;
}

void MappedLog::read_clock(LogFile& file, const LogClock& clock, const std::vector<std::size_t>& columns) {
  std::vector<std::size_t> wanted;
  for (const std::size_t i : columns) wanted.push_back(file.find(mapping_.columns[i].column));
  const std::string& table = file.columns()[wanted.front()].table;
  ClockRows rows;
  try {
    rows = clock_rows(instants_of(file, clock, table), mapping_.phase);
  } catch (const SetupError& error) {
    throw SetupError(mapping_.log.string() + ": " + error.problems().front());
  }
  if (rows.instants.size() < 2)
    throw SetupError(mapping_.log.string() + ": column '" + clock.column + "' does not grow: there are " +
                     std::to_string(rows.instants.size()) + " rows with a time of their own" +
                     told_of_clock(file, file.find(clock.column), clock.unit));
  for (std::string& told : told_rows(rows, clock.column)) warnings_.push_back(std::move(told));
  const auto instants = std::make_shared<const std::vector<std::int64_t>>(std::move(rows.instants));
  std::vector<std::vector<double>> numbers = file.read(wanted);
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const MappedColumn& column = mapping_.columns[columns[i]];
    if (numbers[i].size() != rows.kept.size())
      throw SetupError(mapping_.log.string() + ": column '" + column.column + "' has " +
                       std::to_string(numbers[i].size()) + " rows, and its time '" + clock.column + "' has " +
                       std::to_string(rows.kept.size()) + "; give the column a 'time' of its own");
    std::vector<double> values = kept_values(std::move(numbers[i]), rows.kept);
    if (std::none_of(values.begin(), values.end(), [](double value) { return std::isfinite(value); }))
      throw SetupError(mapping_.log.string() + ": column '" + column.column + "' has no number");
    if (column.turn > 0.0) {
      const Unwrapped unwrapped = unwrap(values, column.turn);
      if (unwrapped.steps > 0)
        warnings_.push_back("column '" + column.column + "' leaps by a turn " +
                            std::to_string(unwrapped.steps) + (unwrapped.steps == 1 ? " time" : " times") +
                            ", first in row " + std::to_string(unwrapped.first_row + 1) +
                            ": it was unwrapped");
    }
    for (double& value : values) value = column.scale * value + column.offset;
    tracks_[columns[i]] = log_track(instants, std::move(values));
  }
  const bool has_joints = std::any_of(columns.begin(), columns.end(), [&](std::size_t i) {
    return mapping_.columns[i].signal == "joints.active";
  });
  if (!has_joints) return;
  rows_ = instants->size();
  repeated_ = rows.repeated;
  rate_ = clock_rate(*instants);
}

void MappedLog::read(LogFile& file) {
  std::vector<std::string> problems;
  const auto check = [&](const std::string& name) {
    try {
      file.find(name);
    } catch (const SetupError& error) {
      for (const std::string& problem : error.problems()) {
        if (std::find(problems.begin(), problems.end(), problem) == problems.end())
          problems.push_back(problem);
      }
    }
  };
  check(mapping_.clock.column);
  if (!mapping_.clock.second_column.empty()) check(mapping_.clock.second_column);
  for (const MappedColumn& column : mapping_.columns) check(column.column);
  throw_if_any(std::move(problems));
  tracks_.resize(mapping_.columns.size());
  std::vector<bool> done(mapping_.columns.size());
  for (std::size_t i = 0; i < mapping_.columns.size(); ++i) {
    if (done[i]) continue;
    const auto clock_of = [&](std::size_t k) { return mapping_.columns[k].clock.value_or(mapping_.clock); };
    const auto table_of = [&](std::size_t k) {
      return file.columns()[file.find(mapping_.columns[k].column)].table;
    };
    std::vector<std::size_t> together;
    for (std::size_t k = i; k < mapping_.columns.size(); ++k) {
      if (done[k] || !(clock_of(k) == clock_of(i)) || table_of(k) != table_of(i)) continue;
      together.push_back(k);
      done[k] = true;
    }
    read_clock(file, clock_of(i), together);
  }
}

/// From the first row of the joints to their last, or the stretch that is wanted.
void MappedLog::place_samples() {
  std::size_t joint = 0;
  while (joint < mapping_.columns.size() && mapping_.columns[joint].signal != "joints.active") ++joint;
  if (joint == mapping_.columns.size())
    throw SetupError(mapping_.log.string() + ": no column is mapped to entry 0 of joints.active");
  const std::vector<std::int64_t>& instants = *tracks_[joint].instants;
  period_ = mapping_.period.value_or(Time(rate_.period));
  const auto from = static_cast<std::int64_t>(1e9 * mapping_.from);
  start_ = instants.front() + from;
  std::int64_t end = instants.back();
  if (mapping_.to) end = std::min(end, instants.front() + static_cast<std::int64_t>(1e9 * *mapping_.to));
  if (end <= start_)
    throw SetupError(mapping_.log.string() + ": the stretch from " + rounded(mapping_.from) +
                     " s on holds nothing; the log has " +
                     rounded(1e-9 * static_cast<double>(instants.back() - instants.front())) + " s");
  const double periods = static_cast<double>(end - start_) / static_cast<double>(period_.count());
  // Rows that are further apart than three periods leave nothing valid between them.
  if (!(periods < 3.0 * static_cast<double>(instants.size()) + most_gaps))
    throw SetupError(mapping_.log.string() + ": column '" + mapping_.clock.column + "' passes through " +
                     std::to_string(periods) + " periods of the recording in " +
                     std::to_string(instants.size()) + " rows; check the unit of the time, or 'period'");
  samples_ = 1 + static_cast<std::size_t>(periods + 1e-6);
  const double ratio = static_cast<double>(rate_.period) / static_cast<double>(period_.count());
  if (mapping_.period && (ratio > 3.0 || ratio < 0.34))
    throw SetupError(mapping_.file.string() + ": 'period' is " +
                     quantity_text(1e3 * to_seconds(period_), "ms") + ", and the rows of the log are " +
                     quantity_text(1e-6 * static_cast<double>(rate_.period), "ms") +
                     " apart; leave it out, and the recording has the period of the log");
}

void MappedLog::tell(const LogFile& file) {
  for (const std::string& remark : file.remarks()) warnings_.push_back(remark);
  if (rate_.gaps > 0)
    warnings_.push_back(std::to_string(rate_.gaps) + (rate_.gaps == 1 ? " gap" : " gaps") +
                        " of more than three periods, where nothing is valid: the longest " +
                        rounded(rate_.longest_gap) + " s, the first at " + rounded(rate_.first_gap) + " s");
  if (rate_.bridged > 0)
    warnings_.push_back(std::to_string(rate_.bridged) + (rate_.bridged == 1 ? " row is" : " rows are") +
                        " missing one or two at a time: values were interpolated there");
  if (rate_.rate() < 90.0)
    warnings_.push_back("the log has " + rounded(rate_.rate()) +
                        " rows a second: too few for estimates of contact, which need some hundred");
  std::vector<bool> used(file.columns().size());
  const auto use = [&](const std::string& name) {
    if (!name.empty()) used[file.find(name)] = true;
  };
  const auto use_clock = [&](const LogClock& clock) {
    use(clock.column);
    use(clock.second_column);
  };
  use_clock(mapping_.clock);
  for (const MappedColumn& column : mapping_.columns) {
    use(column.column);
    if (column.clock) use_clock(*column.clock);
  }
  for (std::size_t i = 0; i < used.size(); ++i) {
    if (!used[i] && !file.columns()[i].is_alias) unused_.push_back(file.columns()[i].name);
  }
  for (std::size_t i = 0; i < tracks_.size(); ++i) {
    const LogTrack& track = tracks_[i];
    const auto [least, most] = std::minmax_element(track.values.begin(), track.values.end());
    if (*least == *most && track.values.size() > 10 && mapping_.columns[i].signal.starts_with("joints"))
      warnings_.push_back("column '" + mapping_.columns[i].column +
                          "' does not change: " + spread_of(track.values));
    const std::int64_t first = tracks_[i].instants->front() - start_,
                       last = tracks_[i].instants->back() - start_;
    const std::int64_t end = static_cast<std::int64_t>(samples_) * period_.count();
    if (last < 0 || first > end)
      warnings_.push_back("column '" + mapping_.columns[i].column +
                          "' has another time than the joints: its rows begin " +
                          rounded(1e-9 * static_cast<double>(first)) +
                          " s after theirs, and none of them is valid; are the clocks the same?");
  }
}

/// Of the rows by which columns are guessed. A mapped column that follows from others is a warning.
void MappedLog::find_computed(LogFile& file) {
  const auto is_joint = [](const MappedColumn& column) { return column.signal == "joints.active"; };
  const auto joint = std::find_if(mapping_.columns.begin(), mapping_.columns.end(), is_joint);
  const std::string table = file.columns()[file.find(joint->column)].table;
  std::vector<std::size_t> wanted;
  for (std::size_t i = 0; i < file.columns().size(); ++i) {
    const LogColumn& column = file.columns()[i];
    if (column.table == table && !column.is_alias && !column.is_clock) wanted.push_back(i);
  }
  std::vector<std::vector<double>> numbers = file.read(wanted, looked_at_rows);
  std::vector<ColumnNumbers> drives, others, candidates;
  std::set<std::string> mapped;
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    ColumnNumbers column{file.columns()[wanted[i]].name, std::move(numbers[i])};
    const auto is_this = [&](const MappedColumn& each) { return file.find(each.column) == wanted[i]; };
    const auto found = std::find_if(mapping_.columns.begin(), mapping_.columns.end(), is_this);
    const bool is_clock = file.find(mapping_.clock.column) == wanted[i];
    if (found != mapping_.columns.end()) {
      (is_joint(*found) ? drives : others).push_back(column);
      mapped.insert(column.name);
    }
    if (!is_clock && (found == mapping_.columns.end() || !is_joint(*found)))
      candidates.push_back(std::move(column));
  }
  std::vector<double> seconds;
  for (const std::int64_t instant :
       file.read_instants(file.find(mapping_.clock.column), mapping_.clock.unit, looked_at_rows))
    seconds.push_back(instant == no_instant ? NAN : 1e-9 * static_cast<double>(instant));
  computed_ = computed_columns(drives, others, candidates, seconds);
  for (const ComputedColumn& column : computed_) {
    if (!mapped.contains(column.name)) continue;
    warnings_.push_back("column '" + column.name + "' is " + column.words() +
                        ": it was computed and is no sensor, so it tells nothing more; a calibration that "
                        "trusts it fools itself, leave it out of the mapping");
  }
}

bool MappedLog::has(const std::string& signal) const {
  return std::any_of(mapping_.columns.begin(), mapping_.columns.end(),
                     [&](const MappedColumn& column) { return column.signal == signal; });
}

bool MappedLog::is_in_body(const std::string& signal) const {
  return std::any_of(mapping_.columns.begin(), mapping_.columns.end(),
                     [&](const MappedColumn& column) { return column.signal == signal && column.in_body; });
}

MappedLog::Cursor::Cursor(const MappedLog& log, const std::string& signal, int entries)
    : log_(&log), values_(Eigen::VectorXd::Zero(entries)) {
  for (std::size_t i = 0; i < log.tracks_.size(); ++i) {
    if (log.mapping_.columns[i].signal == signal) tracks_.push_back(i);
  }
  rows_.resize(tracks_.size());
}

const Eigen::VectorXd& MappedLog::Cursor::at(std::size_t sample) {
  const std::int64_t instant = log_->instant(sample);
  for (std::size_t i = 0; i < tracks_.size(); ++i) {
    const LogTrack& track = log_->tracks_[tracks_[i]];
    rows_[i] = track.row_before(instant, rows_[i]);
    values_[log_->mapping_.columns[tracks_[i]].entry] = track.at(instant, rows_[i]);
  }
  return values_;
}

}  // namespace flinch
