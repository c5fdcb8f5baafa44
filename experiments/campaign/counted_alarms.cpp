#include "experiments/campaign/counted_alarms.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <limits>
#include <optional>
#include <set>

#include "experiments/campaign/campaign.h"
#include "experiments/campaign/campaign_summary.h"
#include "experiments/campaign/run_result.h"
#include "systems/config/yaml_text.h"
#include "systems/foundation/readable_file.h"
#include "systems/foundation/setup_error.h"

namespace flinch {
namespace {

constexpr double seconds_an_hour = 3600.0;
constexpr const char* where_to_join = "; false alarms are joined where both campaigns have the same values";

/// The grid's keys and values where a group stands, in whatever scenario.
auto grid_of(const CampaignGroup& group) {
  auto grid = group.at;
  std::erase_if(grid, [](const auto& entry) { return entry.first == "scenario"; });
  return grid;
}

}  // namespace

struct AlarmColumns {
  struct Estimator {
    std::string name;
    std::size_t false_alarm, contact_free;
  };
  std::vector<std::size_t> axes;  ///< of the grid
  std::vector<Estimator> estimators;
};

namespace {

AlarmColumns columns_of(const Campaign& campaign, const std::vector<std::string>& names,
                        const std::filesystem::path& table) {
  const auto place_of = [&](const std::string& name) -> std::optional<std::size_t> {
    const auto found = std::find(names.begin(), names.end(), name);
    return found == names.end() ? std::nullopt
                                : std::optional(static_cast<std::size_t>(found - names.begin()));
  };
  AlarmColumns columns;
  std::vector<std::string> problems;
  for (const CampaignAxis& axis : campaign.grid) {
    if (const auto place = place_of(axis.key)) {
      columns.axes.push_back(*place);
    } else {
      problems.push_back(table.string() + ": has no column '" + axis.key + "', an axis of the grid of " +
                         campaign.file.string() + where_to_join);
    }
  }
  const std::string time = ".contact_free_s";
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (!names[i].ends_with(time)) continue;
    const std::string estimator = names[i].substr(0, names[i].size() - time.size());
    if (const auto alarm = place_of(estimator + ".false_alarm"))
      columns.estimators.push_back({estimator, *alarm, i});
  }
  if (columns.estimators.empty())
    problems.push_back(table.string() + ": is no results.csv of flinch campaign: no estimator has a column");
  throw_if_any(std::move(problems));
  return columns;
}

double seconds_in(const std::string& cell) {
  double seconds = 0.0;
  const char* const end = cell.data() + cell.size();
  const auto [rest, error] = std::from_chars(cell.data(), end, seconds);
  return error == std::errc{} && rest == end ? seconds : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

CountedAlarms::CountedAlarms(const std::vector<CampaignGroup>& groups) {
  for (const CampaignGroup& group : groups) {
    Alarms& here = alarms_[{grid_of(group), group.estimator}];
    here.count += group.false_alarms;
    here.hours += group.contact_free / seconds_an_hour;
  }
}

CountedAlarms::CountedAlarms(const Campaign& campaign, std::filesystem::path table)
    : table_(std::move(table)) {
  if (const std::string problem = problem_with_reading(table_); !problem.empty())
    throw SetupError(table_.string() + ": " + problem);
  std::ifstream stream(table_, std::ios::binary);
  std::string line;
  std::getline(stream, line);
  const std::vector<std::string> names = csv_cells(line);
  const AlarmColumns columns = columns_of(campaign, names, table_);
  for (std::size_t number = 2; std::getline(stream, line); ++number) {
    const std::vector<std::string> cells = csv_cells(line);
    if (cells.size() != names.size() || !add(campaign, columns, cells))
      throw SetupError(table_.string() + ":" + std::to_string(number) + ": is no row of this table");
  }
  throw_if_any(missing_values(campaign));
}

bool CountedAlarms::add(const Campaign& campaign, const AlarmColumns& columns,
                        const std::vector<std::string>& cells) {
  Grid grid;
  for (std::size_t i = 0; i < columns.axes.size(); ++i)
    grid.emplace_back(campaign.grid[i].key, cells[columns.axes[i]]);
  for (const AlarmColumns::Estimator& estimator : columns.estimators) {
    if (cells[estimator.contact_free].empty()) continue;  // it did not run in that scenario
    const double seconds = seconds_in(cells[estimator.contact_free]);
    if (!std::isfinite(seconds) || seconds < 0.0) return false;
    const std::string& alarm = cells[estimator.false_alarm];
    if (alarm != "0" && alarm != "1") return false;
    Alarms& here = alarms_[{grid, estimator.name}];
    here.count += alarm == "1" ? 1U : 0U;
    here.hours += seconds / seconds_an_hour;
  }
  return true;
}

std::vector<std::string> CountedAlarms::missing_values(const Campaign& campaign) const {
  std::set<std::pair<std::string, std::string>> there;
  for (const auto& [place, alarms] : alarms_) there.insert(place.first.begin(), place.first.end());
  std::vector<std::string> problems;
  for (const CampaignAxis& axis : campaign.grid) {
    for (std::size_t i = 0; i < axis.values.size(); ++i) {
      if (there.contains({axis.key, yaml_line(*axis.values[i])})) continue;
      problems.push_back(table_.string() + ": has no run with value " + std::to_string(i + 1) + " of '" +
                         axis.key + "' in the grid of " + campaign.file.string() + where_to_join);
    }
  }
  return problems;
}

Alarms CountedAlarms::of(const CampaignGroup& group) const {
  const auto found = alarms_.find({grid_of(group), group.estimator});
  return found == alarms_.end() ? Alarms{} : found->second;
}

}  // namespace flinch
