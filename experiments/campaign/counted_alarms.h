#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace flinch {

struct AlarmColumns;  // of a table
struct Campaign;
struct CampaignGroup;

/// False alarms and the time in which they came.
struct Alarms {
  std::size_t count = 0;
  double hours = 0.0;

  double rate() const { return hours > 0.0 ? static_cast<double>(count) / hours : 0.0; }  ///< [1/h]
};

/// False alarms of each estimator at each place of a grid, in all scenarios and whatever was touched then.
class CountedAlarms {
 public:
  /// Those before the contacts of a campaign.
  explicit CountedAlarms(const std::vector<CampaignGroup>& groups);
  /// Those in `table`, the results.csv of a campaign of its own that has the grid of `campaign`. Throws
  /// SetupError where it cannot be read, or does not have all of the grid.
  CountedAlarms(const Campaign& campaign, std::filesystem::path table);

  /// Of the group's estimator at its place; zero in zero hours where there are none.
  Alarms of(const CampaignGroup& group) const;
  /// The table; empty: the campaign's own.
  const std::filesystem::path& table() const { return table_; }

 private:
  using Grid = std::vector<std::pair<std::string, std::string>>;  ///< keys and values

  /// Adds a row of the table; returns whether it is one.
  bool add(const Campaign& campaign, const AlarmColumns& columns, const std::vector<std::string>& cells);
  /// Values of the grid that no row has.
  std::vector<std::string> missing_values(const Campaign& campaign) const;

  std::filesystem::path table_;
  std::map<std::pair<Grid, std::string>, Alarms> alarms_;  ///< by place and estimator
};

}  // namespace flinch
