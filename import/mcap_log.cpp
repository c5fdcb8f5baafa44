#include "import/mcap_log.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "import/mcap_records.h"
#include "systems/foundation/problems_of_place.h"

namespace flinch {

McapLog::McapLog(const std::filesystem::path& file) {
  file_ = file;
  out_of(file.string(), [&] { read_file(file); });
  for (std::size_t i = 0; i < topics_.size(); ++i) add_columns(i);
  throw_if_empty("message of ROS 2 that is known: JointState, Imu, WrenchStamped");
}

void McapLog::read_file(const std::filesystem::path& file) {
  std::map<std::uint16_t, std::size_t> topic_of;
  const auto on_channel = [&](const McapChannel& channel) {
    std::unique_ptr<RosTable> table = channel.encoding == "cdr" ? ros_table(channel.schema) : nullptr;
    if (!table) {
      remarks_.push_back("topic '" + channel.topic + "' has messages '" + channel.schema + "' as '" +
                         channel.encoding + "'; left out");
      return;
    }
    topic_of[channel.id] = topics_.size();
    topics_.push_back({channel.topic, std::move(table), {}});
  };
  const auto on_message = [&](std::uint16_t channel, std::uint64_t logged, std::string_view bytes) {
    const auto found = topic_of.find(channel);
    if (found == topic_of.end()) return;
    topics_[found->second].table->add(bytes);
    constexpr std::uint64_t most = std::numeric_limits<std::int64_t>::max();
    topics_[found->second].logged.push_back(logged > most ? no_instant : static_cast<std::int64_t>(logged));
  };
  for (const std::string& remark : read_mcap(file, on_channel, on_message)) remarks_.push_back(remark);
}

void McapLog::add_columns(std::size_t index) {
  const Topic& topic = topics_[index];
  const std::size_t rows = topic.logged.size();
  if (topic.table->damaged() > 0)
    remarks_.push_back("topic '" + topic.name + "': " + std::to_string(topic.table->damaged()) + " of " +
                       std::to_string(rows) + " messages are cut, or no plain CDR; they have no numbers");
  if (rows == 0 || topic.table->damaged() == rows) return;
  const auto add = [&](const std::string& name, const std::string& unit, const Place& place) {
    columns_.push_back({.name = topic.name + "/" + name, .unit = unit, .table = topic.name, .rows = rows});
    places_.push_back(place);
  };
  add("stamp", "ns", {Place::Kind::stamp, index, 0});
  add("logged", "ns", {Place::Kind::logged, index, 0});
  for (std::size_t i = 0; i < topic.table->fields().size(); ++i)
    add(topic.table->fields()[i].name, topic.table->fields()[i].unit, {Place::Kind::number, index, i});
}

const std::vector<std::int64_t>& McapLog::instants(const Place& place) const {
  const Topic& topic = topics_[place.topic];
  return place.kind == Place::Kind::stamp ? topic.table->stamps() : topic.logged;
}

std::vector<std::vector<double>> McapLog::read(std::span<const std::size_t> wanted, std::size_t most_rows) {
  std::vector<std::vector<double>> numbers;
  for (const std::size_t column : wanted) {
    const Place& place = places_[column];
    std::vector<double>& values = numbers.emplace_back();
    if (place.kind == Place::Kind::number) {
      values = topics_[place.topic].table->numbers()[place.field];
    } else {
      for (const std::int64_t instant : instants(place))
        values.push_back(instant == no_instant ? std::nan("") : static_cast<double>(instant));
    }
    values.resize(std::min(values.size(), most_rows));
    for (double& value : values) value = std::isfinite(value) ? value : std::nan("");
  }
  return numbers;
}

std::vector<std::int64_t> McapLog::read_instants(std::size_t column, ClockUnit unit, std::size_t most_rows) {
  const Place& place = places_[column];
  if (place.kind == Place::Kind::number) return instants_of_numbers(column, unit, most_rows);
  std::vector<std::int64_t> found = instants(place);
  found.resize(std::min(found.size(), most_rows));
  if (unit == ClockUnit::ns) return found;
  for (std::int64_t& instant : found)
    instant = instant == no_instant ? no_instant : instant_of(static_cast<double>(instant), unit);
  return found;
}

}  // namespace flinch
